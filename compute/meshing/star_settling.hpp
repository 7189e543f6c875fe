// Nacre: stars that disagree about a quadrilateral decide it by one rule.
#pragma once

#include <utility>
#include <vector>

#include "compute/meshing/stars.hpp"

namespace nacre {

/// Which diagonal divides the quadrilateral of these four items, given in their order around it: true for the one from
/// corners[0] to corners[2]. An edge of a rim is always kept; else the diagonal is the one whose ends have the larger
/// sum of angles, which in a plane is Delaunay's. Ties go to the diagonal with the lowest particle. The answer does not
/// depend on the corner that is named first, nor on the direction around.
bool takes_first_diagonal(const StarItems& items, const std::array<std::uint32_t, 4>& corners);

/// Changes stars that have a triangle which not all of its corners have: where two of them lay different triangles on
/// an edge, the four corners are a quadrilateral, and each of the four stars takes the diagonal of the rule. Several
/// rounds, in each of which every star reads what all were before. `agreed` is kept up to date. `open` are the stars
/// with such a triangle, ascending. Returns what changed as it was before. In parallel.
std::vector<std::pair<std::uint32_t, Star>> settle_stars(const StarItems& items, std::vector<Star>& stars,
                                                         std::vector<std::uint32_t> open);

/// Whether a star has a triangle that not all of its corners have.
bool has_open(const Star& star);

/// What is to be marked as agreed in `star`, of item i: the triangles that are in the stars of all their corners.
std::uint32_t agreed_on(const std::vector<Star>& stars, std::uint32_t i, const Star& star);

}  // namespace nacre
