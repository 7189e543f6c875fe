// Nacre: tests of odd and damaged volumes: the right mesh, or one clear line and no file.
#include "tests/app/mesh_program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

constexpr double ball_volume = 523.6;  // of radius 5

class MeshInputTest : public MeshTest {};

TEST_F(MeshInputTest, AnisotropicAndTurnedVolumesComeOutInTheWorld) {
  // Spacings 1, 2, 0.5 along axes that are turned; the third points backwards, which makes the frame left-handed.
  const std::string file =
      write("a.nrrd", ball_nrrd("space: left-posterior-superior\nspace directions: (0,1,0) (2,0,0) (0,0,0.5)\n"
                                "space origin: (100,-50,7)\n"));
  const json r = mesh(file, {"--out", path("a.stl")});
  expect_sound(r);
  EXPECT_NEAR(r["mesh"]["materials"][0]["volume"], ball_volume, 0.04 * ball_volume) << "1 x 2 x 0.5 is 1";
  const Outcome info = nacre({"info", "--json", path("a.stl")});
  const json box = json::parse(info.out);
  const double lower[3] = {100 + 2 * 2.5, -50 + 2.5, 7 + 0.5 * 2.5};
  const double upper[3] = {100 + 2 * 12.5, -50 + 12.5, 7 + 0.5 * 12.5};
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(box["lower"][axis], lower[axis], 1.1) << axis;
    EXPECT_NEAR(box["upper"][axis], upper[axis], 1.1) << axis;
  }
}

TEST_F(MeshInputTest, NegativeSpacingTurnsTheAxis) {
  const json r = mesh(write("a.nrrd", ball_nrrd("spacings: 1 -1 1\n")));
  expect_sound(r);
  EXPECT_NEAR(r["mesh"]["materials"][0]["volume"], ball_volume, 0.04 * ball_volume);
}

TEST_F(MeshInputTest, WhatTouchesTheFacesIsClosedThere) {
  const std::string file = write("a.nrrd", nrrd<int>({16, 16, 16}, "uchar", unit_spacing, [](int i, int j, int) {
                                   return (i - 7.5) * (i - 7.5) + (j - 7.5) * (j - 7.5) < 20;
                                 }));
  const json r = mesh(file);
  expect_sound(r);
  EXPECT_EQ(r["mesh"]["materials"][0]["euler"], 2) << "a closed cylinder";
}

TEST_F(MeshInputTest, LabelsStoredAsFloats) {
  const json r = mesh(write("a.nrrd", ball_nrrd(unit_spacing, "float")), {"--labels"});
  expect_sound(r);
  EXPECT_EQ(r["input"]["kind"], "labels");
  EXPECT_EQ(r["mesh"]["materials"][0]["label"], 1);
}

TEST_F(MeshInputTest, VoxelsThatAreNoNumberAreOutside) {
  const std::string file =
      write("a.nrrd", nrrd<std::string>({16, 16, 16}, "float", unit_spacing, [](int i, int j, int k) {
              return i < 3 ? "nan" : ball(i, j, k) ? "9.5" : "0.25";
            }));
  const Outcome run = nacre({"mesh", file, "--isovalue", "4", "--report", path("r.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "warning")) << run.err;
  EXPECT_TRUE(contains(run.err, "768")) << "3 x 16 x 16 voxels are counted: " << run.err;
  expect_sound(read_json("r.json"));
}

TEST_F(MeshInputTest, SpeckleIsKeptUnlessToldOtherwise) {
  const std::string file = write("a.nrrd", nrrd<int>({20, 16, 16}, "uchar", unit_spacing, [](int i, int j, int k) {
                                   return i == 17 && j % 6 == 2 && k % 6 == 2 ? 1 : i < 16 ? ball(i, j, k) : 0;
                                 }));
  const json kept = mesh(file);
  EXPECT_EQ(kept["mesh"]["materials"][0]["components"], 1 + 9);
  const Outcome run = nacre({"mesh", file, "--min-component", "2", "--report", path("r.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "9")) << "what is dropped is counted: " << run.err;
  EXPECT_EQ(read_json("r.json")["mesh"]["materials"][0]["components"], 1);
}

TEST_F(MeshInputTest, MaterialsAreChosenAndMerged) {
  const std::string file = write("a.nrrd", nrrd<int>({16, 16, 16}, "uchar", unit_spacing, [](int i, int j, int k) {
                                   return !ball(i, j, k) ? 0 : i < 6 ? 3 : i < 10 ? 4 : 9;
                                 }));
  const auto labels = [&](const Arguments& arguments) {
    std::vector<int> found;
    const json r = mesh(file, arguments);
    expect_sound(r);
    for (const json& material : r["mesh"]["materials"]) found.push_back(material["label"]);
    return found;
  };
  EXPECT_EQ(labels({}), (std::vector<int>{3, 4, 9}));
  EXPECT_EQ(labels({"--materials", "3,9"}), (std::vector<int>{3, 9}));
  EXPECT_EQ(labels({"--merge", "4:3"}), (std::vector<int>{3, 9}));
  EXPECT_EQ(labels({"--merge", "4:3,9:3"}), (std::vector<int>{3}));
  expect_refused(file, 1, {"5", "3"}, {"--materials", "5"});
  expect_refused(file, 1, {"7"}, {"--merge", "7:3"});
}

TEST_F(MeshInputTest, IndicatorVolumesMakeOneMaterialEach) {
  const auto probability = [&](const std::string& name, bool left) {
    return write(name, nrrd<int>({16, 16, 16}, "uchar", unit_spacing,
                                 [left](int i, int j, int k) { return ball(i, j, k) && (i < 8) == left ? 255 : 0; }));
  };
  const std::string a = probability("left.nrrd", true), b = probability("right.nrrd", false);
  const Outcome run = nacre({"mesh", a, b, "--quiet", "--report", path("r.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  const json r = read_json("r.json");
  expect_sound(r);
  EXPECT_EQ(r["input"]["kind"], "indicators");
  EXPECT_EQ(r["mesh"]["materials"][0]["name"], "left");
  EXPECT_EQ(r["mesh"]["materials"][1]["name"], "right");
  const std::string other = write("other.nrrd", nrrd<int>({8, 16, 16}, "uchar", unit_spacing, ball));
  expect_failure(nacre({"mesh", a, other, "--quiet"}), 1, {"left.nrrd", "other.nrrd"});
}

TEST_F(MeshInputTest, ScalarsNeedAnIsovalueWithinTheirRange) {
  const std::string file =
      write("a.nrrd", nrrd<double>({16, 16, 16}, "float", unit_spacing, [](int i, int j, int k) {
              return std::sqrt((i - 7.5) * (i - 7.5) + (j - 7.5) * (j - 7.5) + (k - 7.5) * (k - 7.5)) + 0.01;
            }));
  expect_refused(file, 1, {"--isovalue"});
  expect_refused(file, 1, {"99"}, {"--isovalue", "99"});
  expect_refused(file, 1, {}, {"--threshold", "90:99"});
  const json shells = mesh(file, {"--isovalue", "3,6"});
  expect_sound(shells);
  EXPECT_EQ(shells["mesh"]["materials"].size(), 2u);
  const json region = mesh(file, {"--threshold", "3:6"});
  expect_sound(region);
  EXPECT_EQ(region["mesh"]["materials"][0]["euler"], 4) << "a hollow ball";
}

TEST_F(MeshInputTest, NothingToMeshIsSaid) {
  const auto constant = [&](const std::string& name, int value) {
    return write(name, nrrd<int>({8, 8, 8}, "uchar", unit_spacing, [value](int, int, int) { return value; }));
  };
  expect_refused(constant("zero.nrrd", 0), 1, {"zero.nrrd"});
  expect_refused(
      write("nan.nrrd", nrrd<std::string>({8, 8, 8}, "float", unit_spacing, [](int, int, int) { return "nan"; })), 1,
      {});
}

TEST_F(MeshInputTest, DamagedHeadersAreNamed) {
  expect_refused(write("zero.nrrd", ball_nrrd("spacings: 1 0 1\n")), 1, {"zero.nrrd", "spacing"});
  expect_refused(write("shear.nrrd", ball_nrrd("space: left-posterior-superior\n"
                                               "space directions: (1,0,0) (0.5,1,0) (0,0,1)\n")),
                 1, {"shear.nrrd", "shear"});
  expect_refused(write("flat.nrrd", "NRRD0004\ntype: uchar\ndimension: 2\nsizes: 2 2\nencoding: ascii\n\n0 1 1 0\n"), 1,
                 {"flat.nrrd"});
  expect_refused(write("four.nrrd",
                       "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 2 2 2 2\nencoding: ascii\n\n"
                       "0 1 1 0 0 1 1 0 0 1 1 0 0 1 1 0\n"),
                 1, {"four.nrrd"});
  expect_refused(write("huge.nrrd",
                       "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 99999999 99999999 99999999\n"
                       "encoding: raw\n\nabc"),
                 1, {"huge.nrrd"});
  expect_refused(write("short.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 64 64 64\nencoding: raw\n\nabc"), 1,
                 {"short.nrrd"});
  expect_refused(write("text.nrrd", "not a volume at all"), 1, {"text.nrrd"});
  expect_refused(write("mesh.obj", "v 0 0 0\n"), 1, {"mesh.obj"});
}

TEST_F(MeshInputTest, MoreParticlesThanFitAreRefusedBeforeTheWork) {
  const Outcome run = nacre(
      {"mesh", "--sample", "head", "--quiet", "--min-size", "0.05", "--max-size", "0.05", "--out", path("never.vtp")});
  expect_failure(run, 1, {"particles", "the boundaries ask for at least", "--m"});  // before there are fields
  EXPECT_FALSE(exists("never.vtp"));
}

TEST_F(MeshInputTest, SizesComeFromAnImageOnAnotherGrid) {
  const std::string file = write("a.nrrd", ball_nrrd("spacings: 0.5 0.5 0.5\n"));
  // 4 x 4 x 4 voxels of 3 mm over the 8 mm of the ball: 0.3 mm in the half with small x, no wish in the other.
  const auto wish = [](int i, int, int) { return i < 2 ? 0.3 : -1; };
  const std::string frame =
      "space dimension: 3\nspace directions: (3,0,0) (0,3,0) (0,0,3)\nspace origin: (-0.75,-0.75,-0.75)\n";
  const std::string sizes = write("s.nrrd", nrrd<double>({4, 4, 4}, "float", frame, wish));
  const auto triangles = [&](const Arguments& more) {
    return mesh(file, Arguments{"--max-size", "2", "--epsilon", "2"} + more)["mesh"]["triangles"].get<int>();
  };
  const int coarse = triangles({}), half = triangles({"--size-image", sizes});
  EXPECT_GT(half, 2 * coarse);
  EXPECT_LT(half, 8 * coarse) << "the other half is as it was";
}

TEST_F(MeshInputTest, AnImageOfSizesThatSaysNothingOrDoesNotExistIsRefused) {
  const std::string file = write("a.nrrd", ball_nrrd());
  const std::string empty =
      write("s.nrrd", nrrd<int>({4, 4, 4}, "uchar", "spacings: 3 3 3\n", [](int, int, int) { return 0; }));
  expect_refused(file, 1, {"the image of sizes asks for nothing"}, {"--size-image", empty});
  expect_refused(file, 1, {"missing.nrrd"}, {"--size-image", path("missing.nrrd")});
}

}  // namespace
}  // namespace nacre::test
