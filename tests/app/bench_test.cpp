// Nacre: `nacre bench`: its words, a small table as text, JSON and plot, and the guard against losses.
#include <cmath>

#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

const Words small_bench = {"bench", "--small", "--quiet", "--device", "cpu", "--threads", "1"};

const json* find(const json& list, const std::string& name) {
  for (const json& one : list)
    if (one.at("name") == name) return &one;
  return nullptr;
}

/// Multiplies our figures of all quantities that say which way is better.
json with_ratios_times(json report, double higher, double lower) {
  for (json& table : report["tables"])
    for (json& row : table["rows"])
      for (json& value : row["values"])
        if (value.contains("better"))
          value["ours"] = value["ours"].get<double>() * (value["better"] == "higher" ? higher : lower);
  return report;
}

class BenchTest : public AppTest {
 protected:
  /// Compares a fresh run of the arena's side result with `last`.
  Outcome compare(const json& last) const {
    return nacre(small_bench + Words{"arena", "--against", write("last.json", last.dump())});
  }
  json arena_report() const {
    const Outcome run = nacre(small_bench + Words{"arena", "--json", path("arena.json")});
    EXPECT_EQ(run.status, 0) << run.err;
    return read_json("arena.json");
  }
};

TEST_F(BenchTest, ATableStandsBesideTheSourcesFigures) {
  const Outcome run = nacre(small_bench + Words{"3.4", "--json", path("bench.json"), "--plots", path("plots")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(lines_with(run.out, "Table 3.4"), 1) << run.out;
  EXPECT_EQ(lines_with(run.out, "Table "), 1);
  EXPECT_TRUE(contains(run.out, path("bench.json")));
  const json report = read_json("bench.json");
  EXPECT_EQ(report["command"], "bench");
  EXPECT_EQ(report["small"], true);
  EXPECT_EQ(report["device"]["threads"], 1);
  const json* table = find(report["tables"], "3.4");
  ASSERT_TRUE(table);
  const json* row = find((*table)["rows"], "8, 2");
  ASSERT_TRUE(row);
  const json& values = (*row)["values"];
  EXPECT_EQ(values["serial: s"]["source"], 3798.74);  // Table 3.4, first row
  EXPECT_EQ(values["red-black: particles"]["source"], 323762);
  EXPECT_EQ(values["serial / red-black"]["source"], 23.7);
  for (const char* quantity : {"serial: s", "red-black: s", "tree: s", "tree: particles"})
    EXPECT_GT(values[quantity]["ours"].get<double>(), 0) << quantity;
  EXPECT_NEAR(values["serial / tree"]["ours"].get<double>(),
              values["serial: s"]["ours"].get<double>() / values["tree: s"]["ours"].get<double>(), 1e-9);
  // Smaller epsilon and delta: more particles.
  const json* fine = find((*table)["rows"], "0.125, 0.125");
  ASSERT_TRUE(fine);
  EXPECT_GT((*fine)["values"]["tree: particles"]["ours"], values["tree: particles"]["ours"]);
  const std::string plot = content("plots/figure-3.10.svg");
  EXPECT_TRUE(contains(plot, ">tree, ours<") && contains(plot, ">serial, source<"));
}

TEST_F(BenchTest, FlowTablesGrow) {
  const Outcome run = nacre(small_bench + Words{"6.2", "--json", path("bench.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  const json report = read_json("bench.json");
  const json* table = find(report["tables"], "6.2");
  ASSERT_TRUE(table);
  const json *coarse = find((*table)["rows"], "train 256"), *fine = find((*table)["rows"], "train 512");
  ASSERT_TRUE(coarse && fine);
  EXPECT_EQ((*fine)["values"]["voxels"]["source"], 930803);
  EXPECT_FALSE((*coarse)["values"]["voxels"].contains("source"));
  // Twice as fine: four times the surface, in a band of the same cells.
  EXPECT_NEAR((*fine)["values"]["growth of voxels"]["ours"].get<double>(), 4, 0.6);
  EXPECT_GT((*fine)["values"]["sparseness, %"]["ours"], 98);
}

TEST_F(BenchTest, LossesFailAndNameTheirRow) {
  const json report = arena_report();
  const Outcome lost = compare(with_ratios_times(report, 10, 0.1));
  EXPECT_EQ(lost.status, 1);
  EXPECT_TRUE(contains(lost.err, "Table arena, arrays of a turn, on the fly / arena")) << lost.err;
  const Outcome gained = compare(with_ratios_times(report, 0.1, 10));
  EXPECT_EQ(gained.status, 0) << gained.err;
  EXPECT_TRUE(contains(gained.out, "none lost more than 30%")) << gained.out;
}

TEST_F(BenchTest, OnlyRunsOfOneKindAreCompared) {
  json report = {{"small", false}, {"device", {{"backend", "cpu"}, {"threads", 1}}}, {"tables", json::array()}};
  EXPECT_EQ(compare(report).status, 1);
  report["small"] = true;
  const Outcome nothing = compare(report);
  EXPECT_EQ(nothing.status, 1);
  EXPECT_TRUE(contains(nothing.err, "nothing to compare")) << nothing.err;
  report["device"]["threads"] = 7;
  EXPECT_TRUE(contains(compare(report).err, "7 threads"));
}

TEST_F(BenchTest, BadWordsAndFilesAreFoundBeforeTheWork) {
  expect_failure(nacre({"bench", "7.1"}), 2, {"7.1", "6.2"});
  expect_failure(nacre(small_bench + Words{"--json", path("none/bench.json")}), 1, {"bench.json", "create the folder"});
  expect_failure(nacre(small_bench + Words{"--against", path("none.json")}), 1, {"none.json"});
  for (const char* text : {"", "{", "[]", "{}", R"({"small":true,"device":{"backend":"cpu","threads":1},"tables":[1]})",
                           R"({"small":true,"device":{"backend":"cpu","threads":1},"tables":[{"name":"3.1","rows":[
                              {"name":"heart","values":{"x":{"ours":"no","better":"higher"}}}]}]})"})
    expect_failure(nacre(small_bench + Words{"--against", write("bad.json", text)}), 1, {"bad.json"});
}

}  // namespace
}  // namespace nacre::test
