// Nacre: from volumes of labels, indicator functions or scalars to conformal meshes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "error.hpp"
#include "export.hpp"
#include "knobs.hpp"
#include "run.hpp"

namespace nacre {

/// Type of the values of a volume, in the byte order of the machine.
enum class VoxelType { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 };

/// A volume in memory of the caller, which is read while a Meshing is made, and not afterwards. Voxel (i, j, k) is
/// entry (k * size[1] + j) * size[0] + i, x fastest. Its centre is at
/// origin + sum over a of axes[a] * (index[a] * spacing[a]) in the world.
struct VolumeView {
  const void* values = nullptr;
  VoxelType type = VoxelType::uint8;
  std::array<std::int64_t, 3> size{};      ///< voxels along x, y, z; at least 2 each
  std::array<double, 3> spacing{1, 1, 1};  ///< > 0, world units
  std::array<double, 3> origin{};          ///< centre of voxel (0, 0, 0), world
  std::array<std::array<double, 3>, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< direction of each index in the
                                                                                 ///< world; unit, orthogonal
  std::string name = "volume";                                                   ///< for messages and the report
  std::map<std::int64_t, std::string> names;                                     ///< of labels; may be empty
};

/// The same for an array of C++.
template <class T>
VolumeView volume_view(std::span<const T> values, std::array<std::int64_t, 3> size,
                       std::array<double, 3> spacing = {1, 1, 1}, std::array<double, 3> origin = {}) {
  static_assert(sizeof(T) <= 8 && (std::is_integral_v<T> || std::is_same_v<T, float> || std::is_same_v<T, double>));
  if (size[0] < 0 || size[1] < 0 || size[2] < 0 || std::int64_t(values.size()) != size[0] * size[1] * size[2])
    throw Error("the size of the volume is not that of its values");
  VolumeView view;
  view.values = values.data();
  constexpr int step = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 2 : sizeof(T) == 4 ? 4 : 6;
  if constexpr (std::is_floating_point_v<T>)
    view.type = sizeof(T) == 4 ? VoxelType::float32 : VoxelType::float64;
  else
    view.type = VoxelType(step + (std::is_signed_v<T> ? 1 : 0));
  view.size = size;
  view.spacing = spacing;
  view.origin = origin;
  return view;
}

/// What a label is called and where it is in the arrays of a mesh.
struct Material {
  std::int64_t label = 0;
  std::string name;  ///< may be empty
};

/// The interfaces of all materials as one conformal mesh, world coordinates.
struct Mesh {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< seen from the side of the first material, counter-clockwise
  std::vector<std::array<std::uint16_t, 2>> sides;      ///< per triangle: materials on its two sides, lower one first
  std::vector<Material> materials;                      ///< entry 0 is the outside
  std::vector<std::array<std::uint32_t, 3>> midsides;   ///< knob `element_order` 2: per triangle, the points on its
                                                        ///< edges 01 12 20, which come behind all corners; else empty
  std::string
      origin;  ///< how it came about, a line that `save` writes where the format has a place for it; may be empty
};

/// The insides of the materials. The facets between them are exactly the triangles of the mesh that was filled.
struct Tetrahedra {
  std::vector<std::array<double, 3>> points;           ///< the corners of the mesh first, in its order
  std::vector<std::array<std::uint32_t, 4>> cells;     ///< positive volume
  std::vector<std::uint16_t> material;                 ///< per cell, never 0
  std::vector<std::array<std::uint32_t, 6>> midsides;  ///< knob `element_order` 2: per cell, the points on its edges 01
                                                       ///< 12 20 03 13 23, which come behind all corners; else empty
};

/// Where particles are, world coordinates; one entry per particle in every array.
struct Particles {
  std::vector<std::array<double, 3>> points;
  std::vector<float> size;  ///< distance to be kept from neighbours, world units
  std::vector<float> energy;
  std::vector<std::array<float, 3>> normal;  ///< of the surface; tangent of a junction curve; zero at a junction point
  std::vector<std::uint8_t> order;           ///< 0 at junction points, 1 on curves, 2 on surfaces
};

/// How good a mesh is. Angles in degrees, distances in voxels.
struct MeshQuality {
  double radius_ratio_mean = 0, radius_ratio_min = 0;  ///< 2 r_in / r_circ of triangles: 1 where equilateral
  double angle_min = 0, angle_max = 0;                 ///< of triangles
  double distance_mean = 0, distance_max = 0;          ///< of facet centres from their interface
  bool sound = false;  ///< closed around every material, manifold off junctions, consistent, nothing doubled or flat
  std::vector<std::int64_t> lost_labels;  ///< materials that no triangle touches
  std::vector<std::string> flaws;         ///< what is wrong, with advice, full sentences; empty: nothing
};

/// A mesh run, stage by stage. Labels become triangles between materials, and tetrahedra within them. A run belongs to
/// one thread at a time. Every call throws Error for bad input and too little memory, and Interrupted when
/// RunOptions::stop is set; then the stage that was interrupted can be run again.
class NACRE_API Meshing {
 public:
  enum class Stage {
    materials,  ///< each voxel has its material
    fields,     ///< distance and sizing fields, and the embedding of the interfaces
    particles,  ///< particles have settled on the interfaces
    triangles,  ///< the mesh is there
  };

  /// One volume of labels or scalars, or several indicator volumes on one grid, one per material. `preset`: "source"
  /// for the constants of the thesis; knobs override it.
  explicit Meshing(std::span<const VolumeView> volumes, const KnobValues& knobs = {}, RunOptions options = {},
                   const std::string& preset = "");
  explicit Meshing(const VolumeView& volume, const KnobValues& knobs = {}, RunOptions options = {},
                   const std::string& preset = "");
  ~Meshing();
  Meshing(Meshing&&) noexcept;
  Meshing& operator=(Meshing&&) noexcept;

  Stage stage() const;  ///< the last that is done and still true
  /// Runs the next stage; false where all are done.
  bool advance();
  /// Changes a knob. Stages that depend on it have to run again: `stage` goes back to the one before them, and the
  /// result is that of a new run, to the byte. Which part of the volume is which material is decided only once: its
  /// knobs cannot be changed.
  void set(const std::string& knob, const KnobValue& value);
  KnobValue get(const std::string& knob) const;

  /// Those of the stage that was reached; none before `particles`.
  Particles particles() const;
  /// Runs what is left to do. The reference is valid until the next change.
  const Mesh& mesh();
  const MeshQuality& quality();
  /// Fills the mesh. One of stars, as the knob `triangulation` has them unless told otherwise, is triangulated anew
  /// first, from the same particles: then `mesh` is the new one. The knob `max_cell` bounds the edges. With
  /// `element_order` 2 points on edges of the mesh lie on the interfaces, or nearer to the edges where cells would be
  /// turned inside out. The reference is valid until the next change.
  const Tetrahedra& tetrahedra();

  /// Version, device, knobs, input, timings and measures of what was computed so far, as JSON: what the program writes
  /// as its report.
  std::string report() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes the triangles in the format of the file's extension: surface_extensions(). Every triangle carries the labels
/// on its two sides where the format has a place for them. Triangles with midsides go into .msh, .msh4 and .inp. Throws
/// Error.
NACRE_API void save(const std::filesystem::path& file, const Mesh& mesh);
/// Writes the tetrahedra that `mesh` was filled with: volume_extensions(). Every cell carries its label. Cells
/// with midsides go into all formats but .foam; the mesh's own midsides are left out. Throws Error.
NACRE_API void save(const std::filesystem::path& file, const Mesh& mesh, const Tetrahedra& tetrahedra);
/// Lower case, with dot.
NACRE_API std::vector<std::string> surface_extensions();
NACRE_API std::vector<std::string> volume_extensions();

}  // namespace nacre
