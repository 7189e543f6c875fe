// Nacre: tests of time steps: .pvd, lists of files, families of arrays.
#include "engine/io/array_families.hpp"
#include "tests/engine/io/io_test_files.hpp"

namespace nacre::test {
namespace {

class Series : public ReaderTest {
 protected:
  /// A triangle at height z with the scalar `value` on its points, and perhaps a time.
  static std::string step(double z, double value, const std::string& time = {}) {
    const std::string h = " " + std::to_string(z) + " ", v = std::to_string(value) + " ";
    std::string field;
    if (!time.empty())
      field = "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" format=\"ascii\">" + time +
              "</DataArray></FieldData>";
    return "<VTKFile type=\"PolyData\"><PolyData>" + field +
           "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><PointData><DataArray type=\"Float32\" Name=\"p\" "
           "format=\"ascii\">" +
           v + v + v +
           "</DataArray></PointData><Points><DataArray type=\"Float32\" "
           "NumberOfComponents=\"3\" format=\"ascii\">0 0" +
           h + "1 0" + h + "0 1" + h +
           "</DataArray></Points><Polys>"
           "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>"
           "<DataArray type=\"Int32\" Name=\"offsets\" "
           "format=\"ascii\">3</DataArray></Polys></Piece></PolyData></VTKFile>";
  }

  static std::string pvd(const std::string& entries) {
    return "<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection>" + entries + "</Collection></VTKFile>";
  }
};

TEST_F(Series, CollectionGivesTimesAndParts) {
  write("a.vtp", step(0, 1));
  write("b.vtp", step(0, 2));
  const SurfaceSeries series = open_surface({write(
      "all.pvd",
      pvd("<DataSet timestep=\"0.5\" part=\"0\" file=\"b.vtp\"/><DataSet timestep=\"0.1\" part=\"0\" file=\"a.vtp\"/>"
          "<DataSet timestep=\"0.5\" part=\"1\" file=\"a.vtp\"/><DataSet timestep=\"0.1\" part=\"1\" "
          "file=\"a.vtp\"/>"))});
  EXPECT_EQ(series.name, "all.pvd");
  EXPECT_EQ(series.times, (std::vector<double>{0.1, 0.5}));
  const Surface second = series.load(1);
  EXPECT_EQ(second.triangles.size(), 2u);
  EXPECT_EQ(second.find("p")->values, (std::vector<float>{2, 2, 2, 1, 1, 1}));
  EXPECT_EQ(series.load(0).find("p")->values[0], 1);
  EXPECT_TRUE(series.warnings.empty());
}

TEST_F(Series, ATimeThatRepeatsIsTold) {
  write("a.vtp", step(0, 1));
  write("b.vtp", step(0, 2));
  const SurfaceSeries series = open_surface(
      {write("all.pvd", pvd("<DataSet timestep=\"0.5\" part=\"0\" file=\"a.vtp\"/><DataSet timestep=\"0\" part=\"0\" "
                            "file=\"a.vtp\"/><DataSet timestep=\"0.5\" part=\"0\" file=\"b.vtp\"/>"))});
  EXPECT_EQ(series.times, (std::vector<double>{0, 0.5}));
  ASSERT_EQ(series.warnings.size(), 1u);
  EXPECT_TRUE(contains(series.warnings[0], "time 0.5 repeats; its files, such as 'b.vtp'")) << series.warnings[0];
}

TEST_F(Series, ListOfParaViewGivesTimes) {
  write("a.vtp", step(0, 1));
  write("b.vtp", step(0, 2));
  const std::string begin = "{\"file-series-version\": \"1.0\", \"files\": [";
  const SurfaceSeries series = open_surface({write(
      "all.vtp.series", begin + "{\"name\": \"b.vtp\", \"time\": 2.5}, {\"name\": \"a.vtp\", \"time\": 0.5}]}")});
  EXPECT_EQ(series.times, (std::vector<double>{0.5, 2.5}));
  EXPECT_EQ(series.load(1).find("p")->values[0], 2);
  EXPECT_TRUE(series.warnings.empty());
  const FileInfo info = describe(folder_ / "all.vtp.series");
  EXPECT_EQ(info.kind, "series");
  EXPECT_EQ(info.times, series.times);
  const SurfaceSeries numbered =
      open_surface({write("n.vtu.series", begin + "{\"name\": \"b.vtp\"}, {\"name\": \"a.vtp\", \"time\": 7}]}")});
  EXPECT_EQ(numbered.times, (std::vector<double>{0, 1}));
  EXPECT_EQ(numbered.load(0).find("p")->values[0], 2);
  EXPECT_EQ(numbered.warnings.size(), 1u);
}

TEST_F(Series, ListsThatAreDamagedAreErrors) {
  write("a.vtp", step(0, 1));
  const auto failed = [&](const std::string& text) { return failure("all.vtp.series", text); };
  EXPECT_TRUE(contains(failed("{\"files\": ["), "not a list of files"));
  EXPECT_TRUE(contains(failed(std::string(100000, '[')), "not a list of files"));
  EXPECT_TRUE(contains(failed("{\"files\": []}"), "names no files"));
  EXPECT_TRUE(contains(failed("{\"files\": [{\"time\": 1}]}"), "names no file"));
  EXPECT_TRUE(contains(failed("{\"files\": [{\"name\": \"a.vtp\", \"time\": \"x\"}]}"), "not a number"));
  EXPECT_TRUE(contains(failed("{\"files\": [{\"name\": \"gone.vtp\"}]}"), "gone.vtp"));
  EXPECT_TRUE(contains(failed("{\"files\": [{\"name\": \"all.vtp.series\"}]}"), "a list itself"));
}

TEST_F(Series, CollectionNamesWhatIsMissing) {
  write("a.vtp", step(0, 1));
  const std::string message =
      failure("lost.pvd", pvd("<DataSet timestep=\"0\" file=\"a.vtp\"/><DataSet timestep=\"1\" file=\"gone.vtp\"/>"));
  EXPECT_TRUE(contains(message, "gone.vtp"));
  EXPECT_TRUE(contains(failure("none.pvd", pvd("")), "names no files"));
  EXPECT_TRUE(
      contains(failure("loop.pvd", pvd("<DataSet timestep=\"0\" file=\"loop.pvd\"/>")), "part of something else"));
}

TEST_F(Series, FilesAreOrderedByTheirOwnTimes) {
  const fs::path a = write("s_0.vtp", step(0, 0, "0")), b = write("s_10.vtp", step(0, 10, "10")),
                 c = write("s_5.vtp", step(0, 5, "5"));
  const SurfaceSeries series = open_surface({a, b, c});
  EXPECT_EQ(series.times, (std::vector<double>{0, 5, 10}));
  EXPECT_EQ(series.load(1).find("p")->values[0], 5);
  ASSERT_EQ(series.warnings.size(), 1u);
  EXPECT_TRUE(contains(series.warnings[0], "in the order of the times"));
}

TEST_F(Series, FilesWithoutTimesAreNumbered) {
  const fs::path a = write("a.vtp", step(0, 1)), b = write("b.vtp", step(0, 2));
  const SurfaceSeries series = open_surface({b, a});
  EXPECT_EQ(series.times, (std::vector<double>{0, 1}));
  EXPECT_EQ(series.load(0).find("p")->values[0], 2);
}

TEST_F(Series, MovingSurfacesHaveTheShapeOfEachStep) {
  const SurfaceSeries series = open_surface({write("a.vtp", step(0, 1)), write("b.vtp", step(0.5, 2))});
  EXPECT_TRUE(series.moves);
  EXPECT_EQ(series.warnings.size(), 0u);
  EXPECT_EQ(series.load(0).points[0].z, 0);
  EXPECT_EQ(series.load(1).points[0].z, 0.5);
  EXPECT_EQ(series.load(1).find("p")->values[0], 2);
}

TEST_F(Series, OtherTopologyIsAMotion) {
  const fs::path a = write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  const fs::path fewer = write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const fs::path other = write("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4\nf 1 4 3\n");
  const SurfaceSeries counts = open_surface({a, fewer});
  EXPECT_TRUE(counts.moves);
  EXPECT_EQ(counts.load(1).triangles.size(), 1u);
  const SurfaceSeries joined = open_surface({a, other});
  EXPECT_TRUE(joined.moves);
  EXPECT_FALSE(joined.load(1).triangles == joined.load(0).triangles);
  const SurfaceSeries late = open_surface({a, a, a, fewer, a, a, a});  // the middle is looked at
  EXPECT_TRUE(late.moves);
  const SurfaceSeries hidden = open_surface({a, a, fewer, a, a, a, a, a});
  EXPECT_FALSE(hidden.moves);
  EXPECT_THROW(hidden.load(2), Error) << "a step that does not fit is not shown in silence";
  EXPECT_EQ(hidden.load(3).triangles.size(), 2u);
}

TEST_F(Series, EachMissingFileIsNamed) {
  EXPECT_TRUE(contains(failure({write("a.vtp", step(0, 1)), folder_ / "b.vtp"}), "b.vtp"));
}

PointArray vectors(const std::string& name, float value) { return {name, 3, std::vector<float>(3, value)}; }

TEST(ArrayFamilies, NamesAreTakenApart) {
  NumberedName parts;
  ASSERT_TRUE(split_numbered_name("Velocity_006h", parts));
  EXPECT_EQ(parts.base, "Velocity");
  EXPECT_EQ(parts.unit, "h");
  EXPECT_EQ(parts.number, 6);
  ASSERT_TRUE(split_numbered_name("velocity_0.0044", parts));
  EXPECT_EQ(parts.base, "velocity");
  EXPECT_EQ(parts.number, 0.0044);
  ASSERT_TRUE(split_numbered_name("U12", parts));
  EXPECT_EQ(parts.base, "U");
  for (const char* name : {"Velocity", "12", "_3", "1.5", ""}) EXPECT_FALSE(split_numbered_name(name, parts)) << name;
}

TEST(ArrayFamilies, VectorsMakeSteps) {
  Surface surface;
  surface.arrays = {vectors("U_10", 2), vectors("U_2", 1), vectors("V_2", 3), vectors("V_10", 4), {"p", 1, {5}}};
  const ArrayFamilies families = find_array_families(surface.arrays);
  EXPECT_EQ(families.times, (std::vector<double>{2, 10}));
  select_step(surface, families, 1);
  ASSERT_EQ(surface.arrays.size(), 3u);
  EXPECT_EQ(surface.find("U")->values[0], 2);
  EXPECT_EQ(surface.find("V")->values[0], 4);
  EXPECT_NE(surface.find("p"), nullptr);
}

TEST(ArrayFamilies, TheLongestWins) {
  const ArrayFamilies families = find_array_families(
      {vectors("U_0", 0), vectors("U_1", 0), vectors("V_0", 0), vectors("V_1", 0), vectors("V_2", 0)});
  EXPECT_EQ(families.times.size(), 3u);
  ASSERT_EQ(families.families.size(), 1u);
  EXPECT_EQ(families.families[0].base, "V");
  EXPECT_EQ(families.warnings.size(), 1u);
}

TEST(ArrayFamilies, ScalarsMakeNoStepsTooEasily) {
  const PointArray x1{"x1", 1, {0}}, x2{"x2", 1, {0}}, x3{"x3", 1, {0}};
  EXPECT_TRUE(find_array_families({x1, x2}).times.empty());
  EXPECT_EQ(find_array_families({x1, x2, x3}).times.size(), 3u);
  EXPECT_TRUE(find_array_families({x1, x2, x3, vectors("V", 0)}).times.empty());
  EXPECT_TRUE(find_array_families({vectors("U_0", 0)}).times.empty());
  EXPECT_TRUE(find_array_families({vectors("U_0", 0), vectors("U_1", 0), vectors("U", 0)}).times.empty());
}

}  // namespace
}  // namespace nacre::test
