// Nacre: where stars do not settle, the Delaunay triangulation of the particles around decides.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/interface_facets.hpp"
#include "compute/meshing/star_mesh.hpp"

namespace nacre {

/// What patches know of the particles: where they are in the world, how far apart (world units), and the material at
/// any point.
struct PatchWorld {
  std::span<const Vec3d> points;
  std::span<const double> size;
  std::function<std::vector<std::uint16_t>(std::span<const Vec3d>)> material_at;
};

/// Patches, from one mesh to the next. Particles that have not moved stay in them, which saves the rounds in which they
/// grow; cells of the mesh before are used again where they have the same particles.
class PatchCells {
 public:
  explicit PatchCells(int threads = 0) : threads_(threads) {}

  /// What a patch is made of: guards, too.
  struct Points {
    std::vector<Vec3d> places;
    std::vector<double> size;
    std::vector<std::uint8_t> wanted;  ///< whether facets at it are wanted: then all within its reach is there, too
    friend bool operator==(const Points&, const Points&) = default;
  };
  struct Made {
    Points points;
    DelaunayCells cells;
    std::vector<std::uint16_t> label;  ///< per cell, where it is looked up
  };
  /// Points whose cells are asked for.
  struct Wanted {
    Points points;
    Delaunay* delaunay;  ///< makes their cells: quickly, where it made those of most of them before
  };
  void begin();  ///< a new mesh
  std::unique_ptr<Delaunay> delaunay() const { return std::make_unique<Delaunay>(threads_); }
  /// The cells of each, made side by side where they are not known.
  std::vector<std::shared_ptr<const Made>> make(std::vector<Wanted> wanted, const PatchWorld& world,
                                                const std::atomic<bool>* stop);
  bool was_in_patch(const Vec3d& point) const;  ///< a particle there was in one of the mesh before
  void keep_in_patch(const Vec3d& point);       ///< ... is to be in one of the next

 private:
  using Kept = std::unordered_multimap<std::uint64_t, std::shared_ptr<const Made>>;

  std::shared_ptr<const Made> find(std::uint64_t key, const Points& points);  // known ones, or none

  int threads_;
  Kept now_, before_;  // of this mesh, and of the one before what this has not asked for, by their places
  std::unordered_set<std::uint64_t> in_patch_, in_patch_before_;  // keys of points: of this mesh, and of the one before
};

/// Replaces the triangles at the mesh's unsettled particles by the facets that the Delaunay triangulation of the
/// particles within three sizes has there, between cells of different materials and after `repair_labels`. Where the
/// two kinds of triangles do not meet edge to edge, the particles there are added, and it is done again.
/// `mesh.unsettled` becomes empty; false where edges still do not match after some rounds, or too much is unsettled for
/// this to be worth it: the mesh is then to be made of all cells. `touching` receives where the surface touches itself
/// in a patch (two particles, or one twice). Triangles face as in the world. Depends on its arguments alone.
bool settle_by_cells(StarMesh& mesh, const PatchWorld& world, PatchCells& cells,
                     std::vector<std::array<std::uint32_t, 2>>& touching, const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
