// Nacre: the knob table.
#include "engine/scene/knobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

/// Edit distance, for "did you mean".
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t corner = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = corner + (a[i] != b[j]);
      corner = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string snake_case(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::string range_of(const Knob& knob) {
  if (!knob.choices.empty()) return fmt::format("{}", fmt::join(knob.choices, "|"));
  if (std::holds_alternative<bool*>(knob.value)) return "true|false";
  if (std::holds_alternative<std::string*>(knob.value)) return "text";
  return fmt::format("{:g}..{:g}", knob.min, knob.max);
}

[[noreturn]] void out_of_range(const Knob& knob, const std::string& text) {
  throw Error(fmt::format("{} {} is out of range", knob.option(), text), "", fmt::format("use {}", range_of(knob)));
}

template <class T>
T parse_number(const Knob& knob, const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) out_of_range(knob, text);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(
        fmt::format("{} takes a{} number, not '{}'", knob.option(), std::is_integral_v<T> ? " whole" : "", text));
  if (!(double(value) >= knob.min && double(value) <= knob.max)) out_of_range(knob, text);
  return value;
}

void assign(const Knob& knob, const std::string& text) {
  if (auto* p = std::get_if<int*>(&knob.value)) **p = parse_number<int>(knob, text);
  if (auto* p = std::get_if<double*>(&knob.value)) **p = parse_number<double>(knob, text);
  if (auto* p = std::get_if<std::uint32_t*>(&knob.value)) **p = parse_number<std::uint32_t>(knob, text);
  if (auto* p = std::get_if<bool*>(&knob.value)) {
    if (text != "true" && text != "false" && text != "1" && text != "0")
      throw Error(fmt::format("{} takes true or false, not '{}'", knob.option(), text));
    **p = text == "true" || text == "1";
  }
  if (auto* p = std::get_if<std::string*>(&knob.value)) {
    if (!knob.choices.empty() && std::find(knob.choices.begin(), knob.choices.end(), text) == knob.choices.end())
      throw Error(fmt::format("no {} '{}'", knob.name, text), "", "use " + range_of(knob));
    **p = text;
  }
}

}  // namespace

std::string Knob::option() const {
  std::string dashes = name;
  std::replace(dashes.begin(), dashes.end(), '_', '-');
  return "--" + dashes;
}

std::string Knob::text() const {
  return std::visit([](const auto* value) { return fmt::format("{}", *value); }, value);
}

std::vector<Knob> knobs(Settings& s) {
  FlowParameters& f = s.flow;
  return {
      {"method", "embedding", "", "embedding that the flow runs on", &s.method, 0, 0, {"grid"}},
      {"resolution", "embedding", "cells", "texture cells along the longest side", &f.resolution, 16, 16384, {}},
      {"refine", "embedding", "", "texture cells per closest-point cell and axis", &f.refine, 1, 8, {}},
      {"subcells", "embedding", "", "closest-point cells per coarse cell and axis", &f.subcells, 3, 8, {}},
      {"radius",
       "embedding",
       "cells",
       "band around the surface in closest-point cells; 0: what the stencils need",
       &f.radius,
       0,
       16,
       {}},
      {"crease",
       "embedding",
       "degrees",
       "faces that meet at more than this keep their own normals",
       &s.crease,
       0,
       180,
       {}},
      {"vectors", "flow", "", "array to show, or @swirl, @rotation; empty: the likeliest", &s.vectors, 0, 0, {}},
      {"ttl", "flow", "steps", "how long a particle lives", &f.ttl, 1, 16, {}},
      {"steps", "flow", "", "steps from the first to the last time", &f.steps, 0, 100000, {}},
      {"step_cells",
       "flow",
       "cells",
       "texture cells that the 98th percentile speed moves in a step",
       &f.step_cells,
       0.1,
       64,
       {}},
      {"speed_power", "flow", "", "displacement ~ speed^power: 1 true speeds, 0 all alike", &f.speed_power, 0, 2, {}},
      {"warmup", "flow", "steps", "steps at the first time before the first frame; -1: ttl", &f.warmup, -1, 1000, {}},
      {"sharpen", "flow", "", "Laplacian sharpening between steps", &f.sharpen, 0, 2, {}},
      {"jitter", "flow", "", "share of fresh noise between steps", &f.jitter, 0, 1, {}},
      {"equalise", "flow", "", "local contrast against that of the whole texture, as a share", &f.equalise, 0, 1, {}},
      {"seed", "flow", "", "of the noise: one seed, one result", &f.seed, 0, 4294967295.0, {}},
      {"contrast", "picture", "", "standard deviation of the shown texture", &f.contrast, 0, 1, {}},
      {"color", "picture", "", "array to colour by, speed or none", &s.color, 0, 0, {}},
      {"colormap", "picture", "", "colours", &s.colormap, 0, 0, {}},
      {"camera", "picture", "", "iso, +x, -x, +y, -y, +z, -z or a JSON file", &s.camera, 0, 0, {}},
      {"orbit", "picture", "degrees", "turn of the camera per frame", &s.orbit, -360, 360, {}},
      {"width", "picture", "pixels", "of the picture", &s.width, 16, 16384, {}},
      {"height", "picture", "pixels", "of the picture", &s.height, 16, 16384, {}},
      {"samples", "picture", "", "rays per pixel and axis", &s.samples, 1, 8, {}},
      {"background", "picture", "", "#rrggbb or transparent", &s.background, 0, 0, {}},
      {"legend", "picture", "", "draw the colour legend", &s.legend, 0, 1, {}},
      {"time_stamp", "picture", "", "draw the time", &s.time_stamp, 0, 1, {}},
      {"fps", "picture", "1/s", "frames per second of a video", &s.fps, 1, 240, {}},
  };
}

void set_knob(Settings& settings, const std::string& name, const std::string& text) {
  const std::string wanted = snake_case(name);
  const std::vector<Knob> table = knobs(settings);
  for (const Knob& knob : table)
    if (knob.name == wanted) return assign(knob, text);
  const auto nearest = std::min_element(table.begin(), table.end(), [&](const Knob& a, const Knob& b) {
    return distance(a.name, wanted) < distance(b.name, wanted);
  });
  throw Error(fmt::format("no knob '{}'", name), "",
              fmt::format("did you mean {}? `nacre --knobs` lists all", nearest->name));
}

nlohmann::json knob_values(const Settings& settings) {
  Settings copy = settings;
  nlohmann::json values = nlohmann::json::object();
  for (const Knob& knob : knobs(copy)) std::visit([&](const auto* value) { values[knob.name] = *value; }, knob.value);
  return values;
}

void set_knobs(Settings& settings, const nlohmann::json& values) {
  if (!values.is_object()) throw Error("the session's knobs are no JSON object");
  for (const auto& [name, value] : values.items())
    set_knob(settings, name, value.is_string() ? value.get<std::string>() : value.dump());
}

std::string knob_table() {
  Settings defaults;
  std::string table = fmt::format("{:<12} {:<10} {:<22} {:<8} {}\n", "knob", "default", "range", "unit", "");
  for (const Knob& knob : knobs(defaults))
    table +=
        fmt::format("{:<12} {:<10} {:<22} {:<8} {}\n", knob.name, knob.text(), range_of(knob), knob.unit, knob.help);
  return table;
}

}  // namespace nacre
