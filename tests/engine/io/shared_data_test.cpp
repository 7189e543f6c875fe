// Nacre: tests of the readers on real files, with counts that others found.
#include <cstdlib>
#include <map>
#include <sstream>

#include "tests/engine/io/io_test_files.hpp"

namespace nacre::test {
namespace {

class SharedData : public ::testing::Test {
 protected:
  void SetUp() override { NACRE_NEEDS_SHARED_DATA(""); }

  Surface first_step(const std::string& name) const { return open_surface({data_ / name}).load(0); }

  std::string failure(const std::string& name) const {
    try {
      open_surface({data_ / name});
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  const fs::path data_ = shared_data("");
};

TEST_F(SharedData, CubesHaveTwelveTriangles) {
  for (const char* name : {"e-assimp/OBJ/box.obj",
                           "e-assimp/OBJ/box_without_lineending.obj",
                           "e-assimp/OBJ/cube_usemtl.obj",
                           "e-assimp/OBJ/cube_with_vertexcolors.obj",
                           "e-assimp/OBJ/testmixed.obj",
                           "e-assimp/OFF/Cube.off",
                           "e-assimp/OFF/formatDetection",
                           "e-assimp/PLY/cube.ply",
                           "e-assimp/PLY/cube_binary.ply",
                           "e-assimp/PLY/cube_binary_header_with_RN_newline.ply",
                           "e-assimp/PLY/cube_binary_starts_with_nl.ply",
                           "e-assimp/PLY/cube_uv.ply",
                           "e-misc/comments.off",
                           "e-misc/whitespace.off",
                           "e-misc/jacked.obj",
                           "e-misc/nancolor.obj",
                           "e-misc/negative_indices.obj",
                           "e-obj/models/cube-vertex-w-component.obj",
                           "e-obj/models/cube-vertexcol.obj",
                           "e-obj/models/issue-161-inconsistent-f.obj"}) {
    const Surface cube = first_step(std::string("malformed/") + name);
    EXPECT_EQ(cube.triangles.size(), 12u) << name;
    Vec3d lower(1e30), upper(-1e30);
    for (const Vec3d& p : cube.points) lower = min(lower, p), upper = max(upper, p);
    const Vec3d size = upper - lower;
    EXPECT_NEAR(size.x, size.y, 1e-5 * size.x) << name;
    if (!contains(name, "comments") && !contains(name, "whitespace")) {  // those two stand on a corner
      EXPECT_NEAR(area(cube), 6 * size.x * size.x, 1e-5 * size.x * size.x) << name;
    }
  }
}

TEST_F(SharedData, OnePlyInThreeEncodingsIsOneSurface) {
  const Surface little = first_step("malformed/e-misc/platonic_shelf.ply");
  EXPECT_EQ(little.points.size(), 50u);
  EXPECT_EQ(little.triangles.size(), 80u);
  for (const char* name : {"platonic_shelf_ascii.ply", "platonic_shelf_big_endian.ply"}) {
    const Surface other = first_step(std::string("malformed/e-misc/") + name);
    EXPECT_EQ(other.triangles, little.triangles) << name;
    for (std::size_t i = 0; i < little.points.size(); ++i)
      EXPECT_LT(length(other.points[i] - little.points[i]), 1e-5) << name;
  }
}

TEST_F(SharedData, OneVtpInFiveEncodingsIsTheSame) {
  const FileInfo plain = describe(data_ / "malformed/e-vtk/202-t-edges.vtp");
  EXPECT_EQ(plain.kind, "lines");
  EXPECT_EQ(plain.points, 3005u);
  for (const char* name : {"202-t-edges-appended-zlib.vtp", "202-t-edges-appended.vtp", "202-t-edges-binary-zlib.vtp",
                           "202-t-edges-binary.vtp"}) {
    const FileInfo info = describe(data_ / "malformed/e-vtk" / name);
    EXPECT_EQ(info.kind, "lines") << name;
    EXPECT_EQ(info.points, plain.points) << name;
    EXPECT_EQ(info.lower, plain.lower) << name;
    EXPECT_EQ(info.upper, plain.upper) << name;
    EXPECT_TRUE(contains(failure(std::string("malformed/e-vtk/") + name), "3,030 lines and no faces")) << name;
  }
}

TEST_F(SharedData, DefectiveMeshesHaveTheCountsOfTheCheck) {
  // Lines such as "d-meshes/ogre.obj  V 62194 F 124008 facesizes [3] dupV 0 unusedV 0 badface 0 zeroarea 4 ...".
  std::ifstream list(data_ / "meshes/defects/CHECK.txt");
  int checked = 0;
  for (std::string line; std::getline(list, line);) {
    std::istringstream words(line);
    std::string name, word;
    words >> name;
    std::map<std::string, std::size_t> counts;
    std::size_t value = 0;
    while (words >> word) {
      if (words >> value) counts[word] = value;
      words.clear();
    }
    const fs::path path = data_ / "meshes/defects" / fs::path(name).filename();
    if (!contains(name, "d-meshes") || !counts.contains("V") || !fs::exists(path)) continue;
    SCOPED_TRACE(name);
    const FileInfo info = describe(path);
    EXPECT_EQ(info.points, counts["V"]);
    EXPECT_EQ(info.polygons, counts["F"]);
    if (contains(line, "facesizes [3]")) {
      EXPECT_EQ(info.triangles, counts["F"] - counts["zeroarea"]);
    }
    ++checked;
  }
  EXPECT_GE(checked, 60);
}

TEST_F(SharedData, DrivaerIsTwentySteps) {
  const SurfaceSeries car = open_surface({data_ / "flow/drivaer/drivaer.pvd"});
  ASSERT_EQ(car.steps(), 20u);
  EXPECT_DOUBLE_EQ(car.times.front(), 0.03);
  EXPECT_DOUBLE_EQ(car.times.back(), 0.6);
  EXPECT_TRUE(car.warnings.empty());
  const Surface last = car.load(19);
  EXPECT_EQ(last.points.size(), 24280u);
  EXPECT_EQ(last.triangles.size(), 48588u);
  EXPECT_EQ(last.find("wallShearStress")->components, 3);
}

TEST_F(SharedData, ArraysOfOneFileAreSteps) {
  const SurfaceSeries wind = open_surface({data_ / "flow/wind-sphere/wind_sphere_9steps.vtp"});
  EXPECT_EQ(wind.times, (std::vector<double>{0, 6, 12, 18, 24, 30, 36, 42, 48}));
  ASSERT_EQ(wind.load(3).arrays.size(), 1u);
  EXPECT_EQ(wind.load(3).arrays[0].name, "Velocity");
  EXPECT_NE(wind.load(3).arrays[0].values, wind.load(4).arrays[0].values);

  const SurfaceSeries artery = open_surface({data_ / "flow/artery/artery_wallshear_5steps.vtp"});
  EXPECT_EQ(artery.steps(), 5u);
  EXPECT_NE(artery.load(4).find("WallShearRate"), nullptr);
  EXPECT_NE(artery.load(4).find("Velocity"), nullptr);

  const SurfaceSeries inlet = open_surface({data_ / "flow/pipe/bct.vtp"});
  EXPECT_EQ(inlet.steps(), 101u);
  EXPECT_DOUBLE_EQ(inlet.times[1], 0.0044);
}

TEST_F(SharedData, MovingSurfacesAreRecognised) {
  std::vector<fs::path> can;
  for (const int step : {0, 10, 15, 20, 25, 30, 35, 40, 5})
    can.push_back(data_ / "flow/can-moving" / ("can_" + std::to_string(step) + ".vtp"));
  const SurfaceSeries series = open_surface(can);
  EXPECT_EQ(series.steps(), 9u);
  EXPECT_NEAR(series.times[1], 0.0005, 1e-6);
  EXPECT_TRUE(series.moves);
  EXPECT_FALSE(series.load(8).points == series.load(0).points);
  EXPECT_EQ(series.load(8).points.size(), series.load(0).points.size());
  EXPECT_EQ(series.load(8).triangles.size(), 11168u);
  EXPECT_NE(series.load(8).find("EQPS"), nullptr);
}

TEST_F(SharedData, BadFilesSayWhatIsWrong) {
  EXPECT_TRUE(contains(failure("malformed/e-assimp/OBJ/box_UTF16BE.obj"), "UTF-16"));
  EXPECT_TRUE(contains(failure("malformed/e-assimp/OFF/invalid.off"), "face 3 of 4"));
  EXPECT_TRUE(contains(failure("malformed/e-misc/points_emptyface.ply"), "1,024 points and no faces"));
  EXPECT_TRUE(contains(failure("malformed/e-misc/empty.stl"), "no triangles"));
  EXPECT_TRUE(contains(failure("malformed/e-obj/models/line-prim.obj"), "lines and no faces"));
  EXPECT_TRUE(contains(failure("scalar/ct/engine.vti"), "is a volume"));
  const SurfaceSeries holes = open_surface({data_ / "malformed/e-obj/models/test-nan.obj"});
  EXPECT_TRUE(contains(holes.warnings.at(0), "2 of 36 triangles dropped: NaN or infinite point"));
}

TEST_F(SharedData, EveryFileIsASurfaceOrAClearError) {
  for (const char* folder : {"malformed/e-assimp", "malformed/e-obj", "malformed/e-misc", "meshes", "flow"})
    for (const auto& entry : fs::recursive_directory_iterator(data_ / folder)) {
      const std::string extension = entry.path().extension().string();
      if (!entry.is_regular_file() || extension == ".txt" || extension == ".mtl" || extension == ".vtk" ||
          extension == ".ex2")
        continue;
      SCOPED_TRACE(entry.path().string());
      try {
        EXPECT_FALSE(open_surface({entry.path()}).load(0).triangles.empty());
      } catch (const Error& error) {
        EXPECT_FALSE(contains(error.what(), "\n"));
        EXPECT_TRUE(contains(error.what(), entry.path().filename().string())) << error.what();
      }
    }
}

TEST_F(SharedData, PackedMotorbike) {
  const Surface bike = first_step("meshes/vehicles/motorBike.obj.gz");
  EXPECT_EQ(bike.triangles.size(), 331653u);
}

}  // namespace
}  // namespace nacre::test
