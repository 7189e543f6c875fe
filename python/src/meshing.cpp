// Nacre: mesh runs for Python.
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <nacre/mesh.hpp>

#include "arrays.hpp"
#include "worker.hpp"

namespace nacre::python {
namespace {

using Voxels = nb::ndarray<nb::ro, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

VoxelType type_of(const nb::dlpack::dtype& type) {
  const auto is = [&](nb::dlpack::dtype_code code, int bits) {
    return type.code == std::uint8_t(code) && type.bits == bits && type.lanes == 1;
  };
  using Code = nb::dlpack::dtype_code;
  constexpr int bits[] = {8, 16, 32, 64};
  for (int k = 0; k < 4; ++k) {
    if (is(Code::UInt, bits[k])) return VoxelType(2 * k);
    if (is(Code::Int, bits[k])) return VoxelType(2 * k + 1);
  }
  if (is(Code::Float, 32)) return VoxelType::float32;
  if (is(Code::Float, 64)) return VoxelType::float64;
  throw Error("a volume has values of this type", "", "use 8 to 64 bit integers, float32 or float64");
}

/// Axes of numpy: the last one is x.
VolumeView view_of(const nb::dict& volume) {
  const auto voxels = nb::cast<Voxels>(volume["values"]);
  VolumeView view;
  view.values = voxels.data();
  view.type = type_of(voxels.dtype());
  view.size = {std::int64_t(voxels.shape(2)), std::int64_t(voxels.shape(1)), std::int64_t(voxels.shape(0))};
  view.spacing = nb::cast<std::array<double, 3>>(volume["spacing"]);
  view.origin = nb::cast<std::array<double, 3>>(volume["origin"]);
  view.axes = nb::cast<std::array<std::array<double, 3>, 3>>(volume["axes"]);
  view.name = nb::cast<std::string>(volume["name"]);
  view.names = nb::cast<std::map<std::int64_t, std::string>>(volume["names"]);
  return view;
}

nb::list material_list(const Mesh& mesh) {
  nb::list result;
  for (const Material& m : mesh.materials) result.append(nb::make_tuple(m.label, m.name));
  return result;
}

nb::dict mesh_dict(const Mesh& mesh) {
  nb::dict result;
  result["points"] = rows(mesh.points);
  result["triangles"] = corner_rows(mesh.triangles);
  result["sides"] = rows(mesh.sides);
  result["materials"] = material_list(mesh);
  result["midsides"] = corner_rows(mesh.midsides);
  result["origin"] = mesh.origin;
  return result;
}

nb::dict cells_dict(const Tetrahedra& cells) {
  nb::dict result;
  result["points"] = rows(cells.points);
  result["cells"] = corner_rows(cells.cells);
  result["material"] = column(cells.material);
  result["midsides"] = corner_rows(cells.midsides);
  return result;
}

nb::dict particles_dict(Particles particles) {
  nb::dict result;
  result["points"] = rows(std::move(particles.points));
  result["size"] = column(std::move(particles.size));
  result["energy"] = column(std::move(particles.energy));
  result["normal"] = rows(std::move(particles.normal));
  result["order"] = column(std::move(particles.order));
  return result;
}

nb::dict quality_dict(const MeshQuality& q) {
  nb::dict result;
  result["radius_ratio_mean"] = q.radius_ratio_mean;
  result["radius_ratio_min"] = q.radius_ratio_min;
  result["angle_min"] = q.angle_min;
  result["angle_max"] = q.angle_max;
  result["distance_mean"] = q.distance_mean;
  result["distance_max"] = q.distance_max;
  result["sound"] = q.sound;
  result["lost_labels"] = nb::cast(q.lost_labels);
  result["flaws"] = nb::cast(q.flaws);
  return result;
}

const char* stage_name(Meshing::Stage stage) {
  switch (stage) {
    case Meshing::Stage::materials: return "materials";
    case Meshing::Stage::fields: return "fields";
    case Meshing::Stage::particles: return "particles";
    case Meshing::Stage::triangles: return "triangles";
  }
  return "";
}

Mesh mesh_of(const Rows<double, 3>& points, const Rows<std::int64_t, 3>& triangles, const Rows<std::uint16_t, 2>& sides,
             const std::vector<std::pair<std::int64_t, std::string>>& materials) {
  Mesh mesh;
  mesh.points = to_rows<3>(points);
  mesh.triangles = to_corners<3>(triangles);
  mesh.sides = to_rows<2>(sides);
  for (const auto& [label, name] : materials) mesh.materials.push_back({label, name});
  return mesh;
}

std::vector<std::pair<std::int64_t, std::string>> pairs_of(const nb::list& list) {
  std::vector<std::pair<std::int64_t, std::string>> result;
  for (const nb::handle each : list) {
    const auto pair = nb::cast<nb::tuple>(each);
    result.emplace_back(nb::cast<std::int64_t>(pair[0]), nb::cast<std::string>(pair[1]));
  }
  return result;
}

}  // namespace

void bind_meshing(nb::module_& module) {
  using Run = Runner<Meshing>;
  nb::class_<Run>(module, "Meshing")
      .def(
          "__init__",
          [](Run* self, const nb::list& volumes, const nb::dict& knobs, const std::string& device, int threads,
             const std::string& preset, nb::object progress) {
            std::vector<VolumeView> views;
            for (const nb::handle volume : volumes) views.push_back(view_of(nb::cast<nb::dict>(volume)));
            const KnobValues values = knob_values(knobs);
            new (self) Run(std::move(progress));
            try {
              self->make([&] {
                return std::make_unique<Meshing>(views, values, self->worker().options(device, threads), preset);
              });
            } catch (...) {
              self->~Run();
              throw;
            }
          },
          nb::arg("volumes"), nb::arg("knobs"), nb::arg("device"), nb::arg("threads"), nb::arg("preset"),
          nb::arg("progress").none())
      .def("stage", [](Run& run) { return stage_name(run.run().stage()); })
      .def("advance", [](Run& run) { return run.call([](Meshing& m) { return m.advance(); }); })
      .def("set",
           [](Run& run, const std::string& name, nb::object value) {
             const KnobValue v = knob_value(value);
             run.call([&](Meshing& m) { m.set(name, v); });
           })
      .def("get", [](Run& run, const std::string& name) { return to_python(run.run().get(name)); })
      .def("particles", [](Run& run) { return particles_dict(run.call([](Meshing& m) { return m.particles(); })); })
      .def("mesh", [](Run& run) { return mesh_dict(*run.call([](Meshing& m) { return &m.mesh(); })); })
      .def("tetrahedra",  // and the mesh, if it was triangulated anew
           [](Run& run) {
             bool anew = false;
             const Tetrahedra* filled = run.call([&](Meshing& m) {
               const auto before = m.mesh().triangles;
               const Tetrahedra* made = &m.tetrahedra();
               anew = m.mesh().triangles != before;
               return made;
             });
             nb::dict cells = cells_dict(*filled);
             return nb::make_tuple(cells, anew ? nb::object(mesh_dict(run.run().mesh())) : nb::object(nb::none()));
           })
      .def("quality", [](Run& run) { return quality_dict(*run.call([](Meshing& m) { return &m.quality(); })); })
      .def("report", [](Run& run) { return run.call([](Meshing& m) { return m.report(); }); });

  module.def("save_mesh",
             [](const std::string& file, const Rows<double, 3>& points, const Rows<std::int64_t, 3>& triangles,
                const Rows<std::uint16_t, 2>& sides, const nb::list& materials, const Rows<std::int64_t, 3>& midsides,
                const std::string& origin) {
               Mesh mesh = mesh_of(points, triangles, sides, pairs_of(materials));
               mesh.midsides = to_corners<3>(midsides);
               mesh.origin = origin;
               nb::gil_scoped_release release;
               save(file, mesh);
             });
  module.def("save_cells",
             [](const std::string& file, const Rows<double, 3>& points, const Rows<std::int64_t, 3>& triangles,
                const Rows<std::uint16_t, 2>& sides, const nb::list& materials, const Rows<double, 3>& cell_points,
                const Rows<std::int64_t, 4>& cells, const Column<std::uint16_t>& material,
                const Rows<std::int64_t, 6>& midsides, const std::string& origin) {
               Mesh mesh = mesh_of(points, triangles, sides, pairs_of(materials));
               mesh.origin = origin;
               Tetrahedra filled{to_rows<3>(cell_points), to_corners<4>(cells),
                                 std::vector<std::uint16_t>(material.data(), material.data() + material.shape(0)),
                                 to_corners<6>(midsides)};
               nb::gil_scoped_release release;
               save(file, mesh, filled);
             });
  module.def("surface_extensions", &surface_extensions);
  module.def("volume_extensions", &volume_extensions);
}

}  // namespace nacre::python
