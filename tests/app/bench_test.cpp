// Nacre: `nacre bench`: its arguments, a small table as text, JSON and plot, and the guard against losses.
#include <cmath>

#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

const Arguments small_bench = {"bench", "--small", "--quiet", "--device", "cpu", "--threads", "1"};

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
    return nacre(small_bench + Arguments{"arena", "--against", write("last.json", last.dump())});
  }
  json arena_report() const {
    const Outcome run = nacre(small_bench + Arguments{"arena", "--json", path("arena.json")});
    EXPECT_EQ(run.status, 0) << run.err;
    return read_json("arena.json");
  }
};

using LongBench = BenchTest;

TEST_F(LongBench, ATableStandsBesideTheSourcesFigures) {
  const Outcome run = nacre(small_bench + Arguments{"3.4", "--json", path("bench.json"), "--plots", path("plots")});
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

TEST_F(BenchTest, RowsAreThereWhenTheyAreMeasuredAndOutliveCtrlC) {
  // Stopped when the first row has come; what follows takes seconds.
  const std::string script =
      R"(cd "$0"; "$@" >out & for k in {1..2000}; do grep -q 'on the fly / arena' out && break;
                                sleep 0.05; done; kill -INT $!; wait $!)";
  const Outcome run =
      test::run("/bin/bash", Arguments{"-c", script, folder_.path().string(), program_path} + small_bench +
                                 Arguments{"arena", "grid-octree", "--json", path("bench.json")});
  EXPECT_EQ(run.status, 130) << run.err;
  const std::string out = content("out");
  EXPECT_EQ(lines_with(out, "arrays of a turn  "), 1) << out;
  EXPECT_EQ(lines_with(out, path("bench.json")), 1) << out;
  const json report = read_json("bench.json");
  EXPECT_EQ(report["ended_early"], "interrupted");
  const json& table = report["tables"][0];
  EXPECT_EQ(table["name"], "arena");
  EXPECT_EQ(table["rows"].size(), 1u + lines_with(out, "embedding  "));
  EXPECT_GT(table["rows"][0]["values"]["arena, ms"]["ours"].get<double>(), 0);
  EXPECT_GT(table["seconds"].get<double>(), 0);
  EXPECT_EQ(names(), (Arguments{"bench.json", "out"}));
}

TEST_F(BenchTest, NothingMeasuredReplacesNothing) {
  write("bench.json", "an older one");
  const Outcome run = test::run("/usr/bin/timeout", Arguments{"--preserve-status", "-s", "INT", "0.5", program_path} +
                                                        small_bench + Arguments{"3.2", "--json", path("bench.json")});
  EXPECT_EQ(run.status, 130) << run.err;
  EXPECT_EQ(content("bench.json"), "an older one");
}

TEST_F(BenchTest, ColumnsAreAsWideInEveryTable) {
  const Outcome run = nacre(small_bench + Arguments{"arena", "methods"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto gap = [](int n) { return std::string(std::size_t(n), ' '); };
  EXPECT_EQ(lines_with(run.out, "row" + gap(17) + "quantity" + gap(38) + "source" + gap(8) + "ours  what differs"), 2)
      << run.out;
  EXPECT_EQ(lines_with(run.out, "arrays of a turn    arena, ms" + gap(42) + "-"), 1) << run.out;
  EXPECT_EQ(lines_with(run.out, "train" + gap(81) + "sample train"), 1) << run.out;
}

TEST_F(BenchTest, KnobsTurnWhatTheTableDoesNotSet) {
  const auto particles = [&](const Arguments& more) {
    const Outcome run = nacre(small_bench + Arguments{"3.4", "--set", "iterations=1", "--json", path("a.json")} + more);
    EXPECT_EQ(run.status, 0) << run.err;
    const json row = read_json("a.json")["tables"][0]["rows"][0];
    return row["values"]["tree: particles"]["ours"].get<int>();
  };
  const int usual = particles({});
  EXPECT_LT(particles({"--set", "max_size=3", "--seed", "7"}), 0.7 * usual);
  const json report = read_json("a.json");
  EXPECT_EQ(report["set"], (json{{"iterations", "1"}, {"max_size", "3"}, {"seed", "7"}}));
  write("session.json", R"({"nacre": "session 1", "knobs": {"max_size": 3}})");
  EXPECT_LT(particles({"--session", path("session.json")}), 0.7 * usual);
  const Outcome compared = nacre(small_bench + Arguments{"3.4", "--against", path("a.json")});
  expect_failure(compared, 1, {"iterations 1", "max_size 3"});
}

TEST_F(LongBench, LossesFailAndNameTheirRow) {
  const json report = arena_report();
  const Outcome lost = compare(with_ratios_times(report, 10, 0.1));
  EXPECT_EQ(lost.status, 1);
  EXPECT_TRUE(contains(lost.err, "Table arena, arrays of a turn, on the fly / arena")) << lost.err;
  const Outcome gained = compare(with_ratios_times(report, 0.1, 10));
  EXPECT_EQ(gained.status, 0) << gained.err;
  EXPECT_TRUE(contains(gained.out, "none lost more than 30%")) << gained.out;
}

TEST_F(LongBench, ARowWithRatiosThatIsMissingFailsWithItsName) {
  const json report = with_ratios_times(arena_report(), 0.1, 10);  // what is there gains, however the two runs went
  json last = report;
  json& rows = last["tables"][0]["rows"];
  rows.push_back({{"name", "gone"}, {"values", {{"a / b", {{"ours", 2.0}, {"better", "higher"}}}}}});
  const Outcome gone = compare(last);
  EXPECT_EQ(gone.status, 1);
  EXPECT_TRUE(contains(gone.err, "Table arena, gone")) << gone.err;
  rows.back()["values"]["a / b"].erase("better");  // nothing in it is compared
  EXPECT_EQ(compare(last).status, 0);
  last["tables"].push_back({{"name", "3.1"}, {"rows", rows}});  // not asked for
  last["tables"][1]["rows"][0]["values"]["a / b"] = {{"ours", 2.0}, {"better", "higher"}};
  EXPECT_EQ(compare(last).status, 0);
  last = report;
  last["tables"][0]["rows"][0]["values"]["a / b"] = {{"ours", 2.0}, {"better", "lower"}};
  EXPECT_TRUE(contains(compare(last).err, "Table arena, arrays of a turn, a / b"));
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
  expect_failure(nacre(small_bench + Arguments{"--json", path("none/bench.json")}), 1,
                 {"bench.json", "create the folder"});
  expect_failure(nacre(small_bench + Arguments{"--against", path("none.json")}), 1, {"none.json"});
  for (const char* text : {"", "{", "[]", "{}", R"({"small":true,"device":{"backend":"cpu","threads":1},"tables":[1]})",
                           R"({"small":true,"device":{"backend":"cpu","threads":1},"tables":[{"name":"3.1","rows":[
                              {"name":"heart","values":{"x":{"ours":"no","better":"higher"}}}]}]})"})
    expect_failure(nacre(small_bench + Arguments{"--against", write("bad.json", text)}), 1, {"bad.json"});
}

}  // namespace
}  // namespace nacre::test
