// Nacre: what `nacre bench` measures: tables of rows of quantities, each beside the thesis's figure.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace nacre {

/// Whether more or less of a quantity is better, if it is a ratio between methods that two runs can be compared by.
enum class Better { neither, higher, lower };

struct BenchValue {
  std::string quantity;  ///< with its unit
  std::optional<double> source, ours;
  Better better = Better::neither;
  std::string note;
};

struct BenchRow {
  std::string name;
  std::string input;  ///< what was run on
  std::vector<BenchValue> values;
  std::string left_out;  ///< why there are no figures of ours; empty: there are

  std::optional<double> ours(const std::string& quantity) const;
};

struct BenchTable {
  std::string name;                  ///< "3.1", or a word for a side result
  std::string title;                 ///< what is measured
  std::vector<std::string> differs;  ///< what differs from the thesis beside the hardware
  std::vector<BenchRow> rows;
  double seconds = 0;  ///< that it took

  /// A row without figures of ours: what the thesis has for it, and why there are none.
  void leave_out(std::string row, std::string input, std::string why);
  /// Adds a quantity to `row`, beside the thesis's figure of that name, or `source` where that is given.
  void add(BenchRow& row, std::string quantity, std::optional<double> ours, Better better = Better::neither,
           std::optional<double> source = {}) const;
};

/// a / b; nothing where one of them is missing or b is not positive.
std::optional<double> ratio(std::optional<double> a, std::optional<double> b);

/// The table as text: what stands above its rows. The first line begins "Table 3.1" (or "Side result: arena"), the
/// last names the columns.
std::string table_head(const BenchTable& table);
/// One line per quantity: row, quantity, the thesis's figure, ours, what differs. Columns are as wide for all rows of
/// all tables, so that a row can be printed before the next one is known.
std::string row_text(const BenchRow& row);

/// The table as JSON: {name, title, differs, rows: [{name, input, left_out?, values: {quantity: {source?, ours?,
/// better?, note?}}}], seconds}; missing figures are left out.
nlohmann::json table_json(const BenchTable& table);

}  // namespace nacre
