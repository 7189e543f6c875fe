// Nacre: flow runs for Python.
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <nacre/flow.hpp>

#include "arrays.hpp"
#include "processes.hpp"
#include "worker.hpp"

namespace nacre::python {
namespace {

/// Copies what `array` has, which python/nacre has checked, into `to`.
template <class Number>
void fill(const nb::object& array, std::span<Number> to) {
  const auto from = nb::cast<nb::ndarray<const Number, nb::c_contig, nb::device::cpu>>(array);
  if (from.size() != to.size()) throw Error("an array has another length than there are points");
  std::memcpy(to.data(), from.data(), to.size_bytes());
}

CameraView camera_of(const nb::dict& from) {
  CameraView camera;
  camera.eye = nb::cast<std::array<double, 3>>(from["eye"]);
  camera.target = nb::cast<std::array<double, 3>>(from["target"]);
  camera.up = nb::cast<std::array<double, 3>>(from["up"]);
  camera.height = nb::cast<double>(from["height"]);
  camera.orthographic = nb::cast<bool>(from["orthographic"]);
  return camera;
}

PictureOptions picture_options(nb::handle camera, nb::handle size) {
  PictureOptions options;
  if (nb::isinstance<nb::str>(camera)) options.view = nb::cast<std::string>(camera);
  if (nb::isinstance<nb::dict>(camera)) options.camera = camera_of(nb::cast<nb::dict>(camera));
  if (!size.is_none()) {
    const auto pair = nb::cast<nb::tuple>(size);
    options.width = nb::cast<int>(pair[0]);
    options.height = nb::cast<int>(pair[1]);
  }
  return options;
}

/// The pixels, and how they came about.
nb::tuple image_of(FlowPicture picture) {
  const std::size_t height = std::size_t(picture.height), width = std::size_t(picture.width);
  auto* kept = new std::vector<std::uint8_t>(std::move(picture.pixels));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<std::uint8_t>*>(p); });
  const nb::ndarray<nb::numpy, std::uint8_t> image(kept->data(), {height, width, std::size_t(4)}, owner);
  return nb::make_tuple(image, picture.origin);
}

nb::dict cells_dict(FlowCells cells) {
  nb::dict result;
  result["centre"] = rows(std::move(cells.centre));
  result["closest_point"] = rows(std::move(cells.closest_point));
  result["value"] = column(std::move(cells.value));
  result["velocity"] = rows(std::move(cells.velocity));
  result["normal"] = rows(std::move(cells.normal));
  return result;
}

/// A run, and the processes that share it; null: this one is alone.
struct Run : Runner<Flow> {
  using Runner<Flow>::Runner;
  std::unique_ptr<PythonProcesses> processes;
};

}  // namespace

void bind_flow(nb::module_& module) {
  nb::class_<Run>(module, "Flow")
      .def(
          "__init__",
          [](Run* self, const Rows<double, 3>& points, const Rows<std::int64_t, 3>& triangles,
             const std::vector<double>& times, nb::object positions, nb::object vectors, nb::object scalars,
             const std::vector<std::string>& scalar_names, const std::string& name, const std::string& vector_name,
             const nb::dict& knobs, const std::string& device, int threads, nb::object progress, nb::object processes) {
            SurfaceFlow surface;
            surface.points = to_rows<3>(points);
            surface.triangles = to_corners<3>(triangles);
            surface.times = times;
            surface.scalar_names = scalar_names;
            surface.name = name;
            surface.vector_name = vector_name;
            const KnobValues values = knob_values(knobs);
            new (self) Run(std::move(progress));
            Worker& worker = self->worker();
            // The run lives no longer than the object, which keeps the callables.
            if (!positions.is_none())
              surface.positions = [&worker, call = positions.ptr()](std::size_t step, std::span<double> to) {
                worker.with_python([&] { fill(nb::handle(call)(step), to); });
              };
            if (!vectors.is_none())
              surface.vectors = [&worker, call = vectors.ptr()](std::size_t step, std::span<float> to) {
                worker.with_python([&] { fill(nb::handle(call)(step), to); });
              };
            surface.scalars = [&worker, call = scalars.ptr()](const std::string& array, std::size_t step,
                                                              std::span<float> to) {
              worker.with_python([&] { fill(nb::handle(call)(array, step), to); });
            };
            RunOptions options = worker.options(device, threads);
            if (!processes.is_none()) {
              self->processes = std::make_unique<PythonProcesses>(worker, processes);
              options.processes = self->processes.get();
            }
            try {
              self->make([&] { return std::make_unique<Flow>(std::move(surface), values, std::move(options)); });
            } catch (...) {
              self->~Run();
              throw;
            }
          },
          nb::arg("points"), nb::arg("triangles"), nb::arg("times"), nb::arg("positions").none(),
          nb::arg("vectors").none(), nb::arg("scalars"), nb::arg("scalar_names"), nb::arg("name"),
          nb::arg("vector_name"), nb::arg("knobs"), nb::arg("device"), nb::arg("threads"), nb::arg("progress").none(),
          nb::arg("processes").none(), nb::keep_alive<1, 5>(), nb::keep_alive<1, 6>(), nb::keep_alive<1, 7>(),
          nb::keep_alive<1, 15>())
      .def("frames", [](Run& run) { return run.run().frames(); })
      .def("frame", [](Run& run) { return run.run().frame(); })
      .def("time", [](Run& run) { return run.run().time(); })
      .def("step", [](Run& run) { return run.call([](Flow& f) { return f.step(); }); })
      .def("set",
           [](Run& run, const std::string& name, nb::object value) {
             const KnobValue v = knob_value(value);
             run.call([&](Flow& f) { f.set(name, v); });
           })
      .def("get", [](Run& run, const std::string& name) { return to_python(run.run().get(name)); })
      .def(
          "picture",
          [](Run& run, nb::object camera, nb::object size) {
            const PictureOptions options = picture_options(camera, size);
            return image_of(run.call([&](Flow& f) { return f.picture(options); }));
          },
          nb::arg("camera").none(), nb::arg("size").none())
      .def("cells", [](Run& run) { return cells_dict(run.call([](Flow& f) { return f.cells(); })); })
      .def("sample",
           [](Run& run, const Rows<double, 3>& points) {
             const auto positions = to_rows<3>(points);
             return column(run.call([&](Flow& f) { return f.sample(positions); }));
           })
      .def("save", [](Run& run, const std::string& file) { run.call([&](Flow& f) { f.save(file); }); })
      .def("report", [](Run& run) { return run.call([](Flow& f) { return f.report(); }); });

  module.def("save_picture",
             [](const std::string& file,
                const nb::ndarray<const std::uint8_t, nb::shape<-1, -1, 4>, nb::c_contig, nb::device::cpu>& image,
                const std::string& origin) {
               FlowPicture picture{int(image.shape(1)), int(image.shape(0)),
                                   std::vector<std::uint8_t>(image.data(), image.data() + image.size()), origin};
               nb::gil_scoped_release release;
               save(file, picture);
             });
}

}  // namespace nacre::python
