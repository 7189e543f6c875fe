// Nacre: `nacre bench`: rows as they are measured.
#include "app/bench/bench.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "app/parameter_names.hpp"

namespace nacre {
namespace {

/// At once, for whoever watches: the next row may take minutes.
void print_now(const std::string& text) {
  fmt::print("{}", text);
  std::fflush(stdout);
}

}  // namespace

BenchTable& Bench::begin(std::string name, std::string title, std::vector<std::string> differs) {
  if (scale == BenchScale::tiny) differs.push_back("--tiny: as coarse as possible; the figures mean nothing");
  if (scale == BenchScale::small) differs.push_back("--small: coarser than the source's runs; compare ratios only");
  begun_ = now();
  tables_.push_back({std::move(name), std::move(title), std::move(differs), {}});
  print_now(table_head(tables_.back()));
  return tables_.back();
}

void Bench::row(BenchTable& table, const std::string& name, const std::string& input,
                const std::function<void(BenchRow&)>& work) {
  if (interrupt_flag()) throw Interrupted();
  BenchRow row{name, input, {}, {}};
  try {
    const StatusLine line(common_.quiet, fmt::format("bench {}: {}", table.name, name));
    work(row);
  } catch (const Error& error) {
    if (std::string(error.what()).find("memory") == std::string::npos) throw;
    return leave_out(table, name, row.input, with_options(error.what()));
  }
  table.rows.push_back(std::move(row));
  print_last_row(table);
}

void Bench::leave_out(BenchTable& table, const std::string& name, const std::string& input, const std::string& why) {
  warn(common_, fmt::format("bench {}: {} is left out: {}", table.name, name, why));
  table.leave_out(name, input, why);
  print_last_row(table);
}

void Bench::print_last_row(BenchTable& table) {
  table.seconds = now() - begun_;
  print_now(row_text(table.rows.back()));
}

void Bench::end() {
  meshes.release();
  print_now("\n");
}

const std::vector<BenchPart>& bench_parts() {
  static const std::vector<BenchPart> parts{{"3.1", bench_quality},
                                            {"3.2", bench_solvers},
                                            {"3.3", bench_synthetic},
                                            {"3.4", bench_sizing},
                                            {"gathering", bench_gathering},
                                            {"4.1", bench_material_quality},
                                            {"4.2", bench_material_solvers},
                                            {"4.3", bench_material_stages},
                                            {"5.1", bench_grid_flow},
                                            {"6.1", bench_octree_flow},
                                            {"6.2", bench_neighbour_index},
                                            {"arena", bench_arena},
                                            {"grid-octree", bench_grid_octree},
                                            {"methods", bench_methods},
                                            {"transport", bench_transport}};
  return parts;
}

}  // namespace nacre
