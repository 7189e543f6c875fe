// Nacre: two runs of `nacre bench` compared.
#include "app/bench/against.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

using nlohmann::json;

/// Member `name` of an array's element that has this name; nullptr where there is none.
const json* find_named(const json& list, const std::string& name) {
  for (const json& one : list)
    if (one.at("name") == name) return &one;
  return nullptr;
}

std::string made_how(const json& report) {
  const json& device = report.at("device");
  const int threads = device.at("threads").get<int>();
  const char* size = report.contains("tiny") ? "--tiny" : report.at("small").get<bool>() ? "--small" : "the whole";
  std::string how = fmt::format("{} on {}, {} thread{}", size, device.at("backend").get<std::string>(), threads,
                                threads == 1 ? "" : "s");
  if (report.contains("set"))
    for (const auto& [knob, value] : report.at("set").items())
      how += fmt::format(", {} {}", knob, value.get<std::string>());
  return how;
}

bool has_ratios(const json& row) {
  for (const json& value : row.at("values"))
    if (value.contains("better") && value.contains("ours")) return true;
  return false;
}

void compare_rows(const std::string& table, const json& now, const json& last, RunComparison& result) {
  for (const auto& [quantity, was] : last.at("values").items()) {
    if (!was.contains("better") || !was.contains("ours")) continue;
    const std::string name = fmt::format("Table {}, {}, {}", table, last.at("name").get<std::string>(), quantity);
    const json& values = now.at("values");
    if (!values.contains(quantity) || !values.at(quantity).contains("ours")) {
      result.missing.push_back(name);
      continue;
    }
    const double before = was.at("ours"), is = values.at(quantity).at("ours");
    ++result.compared;
    const bool higher = was.at("better") == "higher";
    const double kept = higher ? is / before : before / is;
    if (kept < 1 - tolerated_loss)
      result.losses.push_back(
          fmt::format("{}: {:.3g}, was {:.3g} ({} is better)", name, is, before, higher ? "higher" : "lower"));
  }
}

/// Throws what nlohmann's `at` throws where something is missing or of another kind.
void check_shape(const json& report) {
  made_how(report);
  for (const json& table : report.at("tables")) {
    table.at("name").get<std::string>();
    for (const json& row : table.at("rows")) {
      row.at("name").get<std::string>();
      for (const auto& [quantity, value] : row.at("values").items()) {
        if (!value.is_object()) throw Error(quantity + " is not a quantity");
        if (value.contains("ours")) value.at("ours").get<double>();
        if (value.contains("better")) value.at("better").get<std::string>();
      }
    }
  }
}

}  // namespace

RunComparison compare_runs(const json& now, const json& last, const std::vector<std::string>& asked) {
  RunComparison result;
  for (const json& table : last.at("tables")) {
    const std::string name = table.at("name");
    const json* same = find_named(now.at("tables"), name);
    if (!same && !asked.empty() && std::find(asked.begin(), asked.end(), name) == asked.end()) continue;
    for (const json& row : table.at("rows")) {
      const json* found = same ? find_named(same->at("rows"), row.at("name")) : nullptr;
      if (found)
        compare_rows(name, *found, row, result);
      else if (has_ratios(row))
        result.missing.push_back(fmt::format("Table {}, {}", name, row.at("name").get<std::string>()));
    }
  }
  return result;
}

json read_bench(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw Error("cannot read " + file.string());
  json report = json::parse(text.str(), nullptr, false);
  const char* advice = "give a file that nacre bench --json wrote";
  if (report.is_discarded() || !report.is_object()) throw Error(file.string() + " is not a JSON object", "", advice);
  try {
    check_shape(report);
  } catch (const std::exception& error) {
    throw Error(file.string() + " is not a report of nacre bench", error.what(), advice);
  }
  return report;
}

void require_comparable(const json& now, const json& last, const std::string& file) {
  const std::string here = made_how(now), there = made_how(last);
  if (here != there)
    throw Error(fmt::format("{} cannot be compared with this run", file),
                fmt::format("it is {}, this is {}", there, here), "make both in the same way");
}

}  // namespace nacre
