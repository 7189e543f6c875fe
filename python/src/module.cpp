// Nacre: the compiled part of the Python module. python/nacre checks arguments; nothing here is called by users.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <nacre/device.hpp>
#include <nacre/surface.hpp>
#include <nacre/version.hpp>

#include "arrays.hpp"
#include "worker.hpp"

namespace nacre::python {

KnobValue knob_value(nb::handle value) {
  if (nb::isinstance<nb::bool_>(value)) return nb::cast<bool>(value);
  if (nb::isinstance<nb::int_>(value)) return nb::cast<std::int64_t>(value);
  if (nb::isinstance<nb::float_>(value)) return nb::cast<double>(value);
  return nb::cast<std::string>(value);
}

KnobValues knob_values(const nb::dict& values) {
  KnobValues result;
  for (const auto& [name, value] : values) result[nb::cast<std::string>(name)] = knob_value(value);
  return result;
}

nb::object to_python(const KnobValue& value) {
  return std::visit([](const auto& stored) -> nb::object { return nb::cast(stored); }, value);
}

namespace {

nb::list knob_list(const std::string& job) {
  nb::list result;
  for (const KnobDescription& knob : describe_knobs(job == "mesh" ? Job::mesh : Job::flow)) {
    nb::dict each;
    each["name"] = knob.name;
    each["help"] = knob.help;
    each["unit"] = knob.unit;
    each["group"] = knob.group;
    each["default"] = to_python(knob.value);
    each["min"] = knob.min;
    each["max"] = knob.max;
    each["choices"] = nb::cast(knob.choices);
    each["live"] = knob.live;
    result.append(each);
  }
  return result;
}

nb::list device_list() {
  nb::list result;
  for (const DeviceDescription& d : devices()) result.append(nb::make_tuple(d.request, d.backend, d.name));
  return result;
}

nb::tuple closest(const Rows<double, 3>& points, const Rows<std::int64_t, 3>& triangles,
                  const Rows<double, 3>& queries) {
  const auto positions = to_rows<3>(points), wanted = to_rows<3>(queries);
  const auto corners = to_corners<3>(triangles);
  ClosestPoints found;
  Worker worker((nb::none()));
  const RunOptions options = worker.options("cpu", 0);
  worker.run([&] { found = closest_points(positions, corners, wanted, options.stop); });
  std::vector<std::int64_t> numbers(found.triangles.begin(), found.triangles.end());
  return nb::make_tuple(rows(std::move(found.points)), column(std::move(numbers)), column(std::move(found.distance)));
}

void raise(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    const nb::object type = nb::module_::import_("nacre._errors").attr("Error");
    PyErr_SetObject(type.ptr(), type(error.problem(), error.why(), error.advice()).ptr());
  } catch (const Interrupted&) {
    const nb::object type = nb::module_::import_("nacre._errors").attr("Interrupted");
    PyErr_SetObject(type.ptr(), type("the progress callback returned False").ptr());
  }
}

}  // namespace
}  // namespace nacre::python

NB_MODULE(_core, module) {
  namespace nb = nanobind;
  using namespace nacre::python;
#ifdef NDEBUG
  nb::set_leak_warnings(false);  // what a user's program still holds when the interpreter ends is not our mistake
#endif
  nb::register_exception_translator(raise);
  module.attr("version") = nacre::library_version();
  module.def("knobs", &knob_list);
  module.def("devices", &device_list);
  module.def("why_no_gpu", &nacre::why_no_gpu);
  module.def("closest_points", &closest);
  bind_meshing(module);
  bind_flow(module);
}
