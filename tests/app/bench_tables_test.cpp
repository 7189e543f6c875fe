// Nacre: the tables of `nacre bench` at the smallest scale: rows, quantities beside the source's, sums, plots.
#include "compute/device/device.hpp"
#include "engine/picture/png.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

const Arguments tiny_bench = {"bench", "--tiny", "--quiet", "--threads", "2", "--set", "iterations=2"};

/// What a run of some tables wrote.
class BenchTables : public AppTest {
 protected:
  void run(const Arguments& more) {
    const Outcome run = nacre(tiny_bench + Arguments{"--json", path("bench.json")} + more);
    status_ = run.status;
    printed_ = run.out;
    errors_ = run.err;
    ASSERT_TRUE(exists("bench.json")) << run.err;
    report_ = read_json("bench.json");
  }

  /// A row that must be there, with as many figures of the source as it has for it, and one of ours beside each.
  json row(const std::string& table, const std::string& name, int from_source) const {
    for (const json& one : report_["tables"])
      for (const json& found : one["rows"])
        if (one["name"] == table && found["name"] == name) {
          int count = 0;
          for (const auto& [quantity, value] : found["values"].items()) {
            count += value.contains("source");
            EXPECT_TRUE(value.contains("ours")) << table << ", " << name << ", " << quantity;
          }
          EXPECT_EQ(count, from_source) << table << ", " << name;
          return found["values"];
        }
    ADD_FAILURE() << "no row " << name << " in table " << table;
    return json::object();
  }

  static double ours(const json& values, const std::string& quantity) {
    EXPECT_TRUE(values.contains(quantity)) << quantity;
    return values.contains(quantity) ? values[quantity].value("ours", -1.0) : -1.0;
  }

  void expect_plot(const std::string& name, const Arguments& texts) const {
    const std::string plot = exists("plots/" + name) ? content("plots/" + name) : "";
    for (const std::string& text : texts) EXPECT_TRUE(contains(plot, ">" + text + "<")) << name << ": " << text;
  }

  void expect_scalar_tables() const;
  void expect_material_tables() const;
  void expect_flow_tables() const;
  void expect_side_results() const;
  void expect_transport() const;

  json report_;
  int status_ = -1;
  std::string printed_, errors_;
};

void BenchTables::expect_scalar_tables() const {
  for (const char* name : {"heart", "lungs", "ribcage"}) {
    const json quality = row("3.1", name, 4), times = row("3.2", name, 5);
    for (const std::string who : {"serial", "red-black", "tree", "own settings"}) {
      EXPECT_LE(ours(quality, who + ": mean ratio"), 1) << name;
      EXPECT_GT(ours(quality, who + ": mean ratio"), ours(quality, who + ": smallest ratio")) << name;
    }
    EXPECT_GT(ours(quality, "own settings: mean ratio"), 0.9) << "smoothed and remeshed, however short the run";
    EXPECT_NEAR(ours(times, "serial / tree"), ours(times, "serial: s") / ours(times, "tree: s"), 1e-9);
  }
  double before = 0;
  for (const int asked : {60000, 180000, 300000}) {
    const json values = row("3.3", std::to_string(asked), 6);
    const double seeds = ours(values, "seeds"), expected = asked * 37.0 * 37 / (268 * 268);
    EXPECT_LT(seeds, 1.1 * expected);
    EXPECT_GT(seeds, 0.3 * expected) << "as many as there is room for";
    EXPECT_GT(seeds, before);
    for (const std::string solver : {"serial", "red-black", "tree"}) {
      EXPECT_LE(ours(values, solver + ": particles"), 1.05 * seeds) << "none are added";
      EXPECT_GT(ours(values, solver + ": particles"), 0.2 * seeds);
    }
    before = seeds;
  }
  const json coarse = row("3.4", "8, 2", 5), fine = row("3.4", "0.125, 0.125", 5);
  for (const std::string solver : {"serial", "red-black", "tree"})
    EXPECT_GT(ours(fine, solver + ": particles"), ours(coarse, solver + ": particles")) << "smaller epsilon and delta";
  const json gathering = row("gathering", "ribcage", 1);
  EXPECT_NEAR(ours(gathering, "copying, % of a turn"),
              100 * ours(gathering, "copying, ms") / ours(gathering, "a turn, ms"), 1e-9);
  expect_plot("figure-3.9.svg", {"serial, ours", "tree, ours", "red-black, source"});
  expect_plot("figure-3.10.svg", {"serial, ours", "tree, ours", "red-black, source"});
}

void BenchTables::expect_material_tables() const {
  for (const char* name : {"torso (pig)", "head"}) {
    const json quality = row("4.1", name, 9), times = row("4.2", name, 9), stages = row("4.3", name, 8);
    for (const std::string who : {"serial", "red-black", "tree", "own settings"}) {
      EXPECT_GT(ours(quality, who + ": seeds"), 100);
      EXPECT_GT(ours(quality, who + ": particles"), 100);
      EXPECT_LE(ours(quality, who + ": mean ratio"), 1);
    }
    EXPECT_NEAR(ours(times, "red-black / tree"), ours(times, "red-black: s") / ours(times, "tree: s"), 1e-9);
    double sum = 0;
    for (const char* part : {"distance volume, s", "sizing field, s", "closest point, s", "extract, s"}) {
      EXPECT_GT(ours(stages, part), 0) << part;
      sum += ours(stages, part);
    }
    EXPECT_NEAR(ours(stages, "total, s"), sum, 1e-9) << "all that is not particles, our embedding too";
    EXPECT_EQ(ours(stages, "particles, tree, s"), ours(times, "tree: s"));
    EXPECT_NEAR(ours(stages, "serial particles / extract"), ours(times, "serial: s") / ours(stages, "extract, s"),
                1e-9);
  }
  expect_plot("figure-4.5.svg", {"distance volume", "sizing field", "closest point", "particles", "extract"});
}

void BenchTables::expect_side_results() const {
  const json both = row("grid-octree", "train 64", 0);
  for (const std::string what : {"build", "step"}) {
    const double source = ours(both, "octree, source: " + what + ", s");
    EXPECT_NEAR(ours(both, what + ", octree of the source / grid"), source / ours(both, "grid: " + what + ", s"), 1e-9);
    EXPECT_NEAR(ours(both, what + ", octree of the source / bricks"),
                source / ours(both, "octree, bricks: " + what + ", s"), 1e-9);
  }
  for (const char* sample : {"train", "delta-wing"}) {
    const json finest = row("grid-octree", std::string(sample) + ", finest", 0);
    EXPECT_GT(ours(finest, "octree, bricks: cells per axis"), ours(finest, "grid: cells per axis"));
  }
  for (const std::string sample : {"train", "aircraft"}) {
    EXPECT_GT(ours(row("methods", sample, 0), "octree, source: embed, steps, picture, s"), 0);
    const Image picture = read_png(path("plots/methods-" + sample + ".png"));
    EXPECT_EQ(picture.width, 3 * 256 + 2 * 8) << "three beside each other";
    EXPECT_GT(picture.height, 192);
  }
}

void BenchTables::expect_transport() const {
  for (const char* sample : {"train", "torus", "pulse"})
    for (const char* what : {"topology, s", "streamlines, s", "flow map, s", "dye step, s"})
      EXPECT_GT(ours(row("transport", sample, 0), what), 0) << sample;
  EXPECT_GT(ours(row("transport", "pulse", 0), "tracks, s"), 0);
}

void BenchTables::expect_flow_tables() const {
  for (const char* name : {"train", "aircraft (F6)", "cylinder"}) {
    const json values = row("5.1", name, 3);
    EXPECT_NEAR(ours(values, "million surface cells / s"),
                ours(values, "surface cells") / 1e6 / ours(values, "UFLIC step, s"), 1e-9);
  }
  for (const std::string sample : {"train", "aircraft", "delta-wing"}) {
    const json coarse = row("6.1", sample + " 64", 0), fine = row("6.1", sample + " 128", 0);
    EXPECT_FALSE(coarse.contains("growth of voxels"));
    EXPECT_NEAR(ours(fine, "growth of voxels"), ours(fine, "voxels") / ours(coarse, "voxels"), 1e-9);
    EXPECT_NEAR(ours(fine, "growth of voxels"), 4, 1) << "twice as fine: four times the surface, in a band of cells";
    EXPECT_NEAR(ours(fine, "sparseness, %"), 100 * (1 - ours(fine, "voxels") / (128.0 * 128 * 128)), 1e-9);
    EXPECT_GT(ours(fine, "voxels"), ours(fine, "bricks: voxels")) << "the source's radius is twice ours";
  }
  for (const char* name : {"figure-6.8a.svg", "figure-6.8b.svg", "figure-6.8c.svg"})
    expect_plot(name, {"train, octree", "train, bricks", "delta-wing, octree", "64", "128"});
}

/// All tables are asked for, beside a run that had one more: that is a loss, and the only one.
using LongBenchTables = BenchTables;

TEST_F(LongBenchTables, EveryTableAndOneThatIsMissing) {
  const json ratio = {{"name", "a row"}, {"values", {{"a / b", {{"ours", 2.0}, {"better", "higher"}}}}}};
  const json last = {{"small", true},
                     {"tiny", true},
                     {"set", {{"iterations", "2"}}},
                     {"device", {{"backend", "cpu"}, {"threads", 2}}},
                     {"tables", {{{"name", "9.9"}, {"rows", {ratio}}}}}};
  run({"--device", "cpu", "--plots", path("plots"), "--against", write("last.json", last.dump())});
  EXPECT_EQ(status_, 1);
  EXPECT_TRUE(contains(errors_, "has no value where") && contains(errors_, "Table 9.9, a row")) << errors_;
  EXPECT_EQ(lines_with(errors_, "nacre"), 1) << errors_;
  EXPECT_EQ(report_["tables"].size(), 15u);
  for (const char* table : {"3.1", "3.2", "3.3", "3.4", "4.1", "4.2", "4.3", "5.1", "6.1", "6.2"})
    EXPECT_EQ(lines_with(printed_, std::string("Table ") + table + " "), 1) << table;
  expect_scalar_tables();
  expect_material_tables();
  expect_flow_tables();
  expect_side_results();
  expect_transport();
}

TEST_F(BenchTables, TheSerialSolversRowsAreOfTheCpuBesideAGpu) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  run({"--device", "cuda", "3.1", "3.2", "3.3", "3.4", "4.1", "4.2", "4.3", "--plots", path("plots")});
  ASSERT_EQ(status_, 0) << errors_;
  for (const json& table : report_["tables"])
    for (const json& one : table["rows"]) EXPECT_TRUE(contains(one["input"], "serial on the CPU")) << one;
  EXPECT_GT(ours(row("3.2", "heart", 5), "serial: s"), 0);
  expect_material_tables();
}

}  // namespace
}  // namespace nacre::test
