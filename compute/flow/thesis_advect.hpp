// Nacre: particles as the thesis releases them (sec. 6.2.1), on its octree of cells.
#pragma once

#include "compute/flow/band_advect.hpp"

namespace nacre {

/// Releases a particle from the centre of every cell at the beginning of a step and lets it live `ttl` steps; what it
/// carries goes to the cells under its path, in step j of its life to the buffer of that step (Shen & Kao 1997).
template <class View>
struct ReleaseParticles {
  BandPath<View> path;
  const float* carried;          ///< per surface cell, 0..1
  std::uint64_t* sums[max_ttl];  ///< buffers of the coming steps
  int ttl;

  using Cursor = typename View::Cursor;

  NACRE_HD void operator()(CellIndex home, CellIndex, const Int3& position, Cursor& cursor) const {
    const std::uint64_t word = Deposit::pack(Deposit::quantise(carried[home]));
    BandPoint p{position, Vec3f(0.5f)};
    Cursor drawing = cursor;
    atomic_add(sums[0] + home, word);
    CellIndex here = home;
    for (int j = 0; j < ttl; ++j) {
      const int hits = path.walk(j, p, sums[j], word, cursor, drawing);
      if (hits > 0 || j == 0) continue;
      const CellIndex found = drawing.find_surface(p.cell());
      here = found == no_cell ? here : found;
      atomic_add(sums[j] + here, word);
    }
  }
};

}  // namespace nacre
