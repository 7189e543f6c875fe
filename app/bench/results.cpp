// Nacre: tables of `nacre bench` as text and JSON.
#include "app/bench/results.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "app/bench/thesis_figures.hpp"

namespace nacre {
namespace {

/// Four digits; counts in full.
std::string number(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return "-";
  if (*value == std::floor(*value) && std::fabs(*value) < 1e15) return fmt::format("{:.0f}", *value);
  return std::fabs(*value) >= 1000 ? fmt::format("{:.0f}", *value) : fmt::format("{:.4g}", *value);
}

const char* better_word(Better better) { return better == Better::higher ? "higher" : "lower"; }

/// One line. The longest names are "delta-wing, finest" and "red-black: us per particle and iteration".
std::string columns(const std::string& name, const std::string& quantity, const std::string& source,
                    const std::string& ours, const std::string& differs) {
  std::string line = fmt::format("{:<18}  {:<40}  {:>10}  {:>10}  {}", name, quantity, source, ours, differs);
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

}  // namespace

std::optional<double> BenchRow::ours(const std::string& quantity) const {
  for (const BenchValue& value : values)
    if (value.quantity == quantity) return value.ours;
  return {};
}

void BenchTable::leave_out(std::string row, std::string input, std::string why) {
  rows.push_back({std::move(row), std::move(input), {}, std::move(why)});
  BenchRow& added = rows.back();
  for (const ThesisFigure& figure : thesis_figures())
    if (figure.table == name && figure.row == added.name)
      added.values.push_back(
          {std::string(figure.quantity), figure.value, {}, Better::neither, std::string(figure.note)});
}

void BenchTable::add(BenchRow& row, std::string quantity, std::optional<double> ours, Better better,
                     std::optional<double> source) const {
  BenchValue value{std::move(quantity), source, ours, better, {}};
  if (!source) {
    if (const ThesisFigure* figure = find_thesis_figure(name, row.name, value.quantity)) {
      value.source = figure->value;
      value.note = figure->note;
    }
  }
  row.values.push_back(std::move(value));
}

std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  if (!a || !b || !(*b > 0)) return {};
  return *a / *b;
}

std::string table_head(const BenchTable& table) {
  const bool side = !std::isdigit(static_cast<unsigned char>(table.name.front()));
  std::string text = fmt::format("{} {}  {}\n", side ? "Side result:" : "Table", table.name, table.title);
  for (const std::string& line : table.differs) text += fmt::format("  {}\n", line);
  return text + columns("row", "quantity", "source", "ours", "what differs");
}

std::string row_text(const BenchRow& row) {
  std::string name = row.name, differs = row.left_out.empty() ? row.input : row.input + "; left out: " + row.left_out;
  if (row.values.empty()) return columns(name, "", "", "", differs);
  std::string text;
  for (const BenchValue& value : row.values) {
    if (!value.note.empty()) differs += (differs.empty() ? "" : "; ") + ("source: " + value.note);
    text += columns(name, value.quantity, number(value.source), number(value.ours), differs);
    name.clear(), differs.clear();
  }
  return text;
}

nlohmann::json table_json(const BenchTable& table) {
  nlohmann::json rows = nlohmann::json::array();
  for (const BenchRow& row : table.rows) {
    nlohmann::json values = nlohmann::json::object();
    for (const BenchValue& value : row.values) {
      nlohmann::json& one = values[value.quantity] = nlohmann::json::object();
      if (value.source) one["source"] = *value.source;
      if (value.ours && std::isfinite(*value.ours)) one["ours"] = *value.ours;
      if (value.better != Better::neither) one["better"] = better_word(value.better);
      if (!value.note.empty()) one["note"] = value.note;
    }
    rows.push_back({{"name", row.name}, {"input", row.input}, {"values", values}});
    if (!row.left_out.empty()) rows.back()["left_out"] = row.left_out;
  }
  return {{"name", table.name},
          {"title", table.title},
          {"differs", table.differs},
          {"rows", rows},
          {"seconds", table.seconds}};
}

}  // namespace nacre
