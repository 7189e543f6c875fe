// Nacre: tests of the OBJ, OFF, STL and PLY readers on small files.
#include <zlib.h>

#include <algorithm>

#include "tests/engine/io/io_test_files.hpp"

namespace nacre::test {
namespace {

class TextFormats : public ReaderTest {};

const std::string cube_points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";

TEST_F(TextFormats, ObjQuadsMakeACube) {
  const Surface cube =
      read("cube.obj", cube_points + "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  EXPECT_EQ(cube.points.size(), 8u);
  EXPECT_EQ(cube.triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(area(cube), 6);
  EXPECT_NEAR(volume(cube), 1, 1e-12);
}

TEST_F(TextFormats, ObjTakesEverySpellingOfAFace) {
  const Surface s = read("odd.obj",
                         "v 0 0 0 0.5 0.5 0.5\nv +1.0e0 0 0 # comment\n  v 0 1. 0\r\nvt 0 0\nvn 0 0 1\n"
                         "f -3 -2 -1\nf 1/1 2/1 3/1 # 4\nf 1//1 2//1 3//1\nf 1/1/1 \\\n2/1/1 3/1/1\n");
  ASSERT_EQ(s.triangles.size(), 4u);
  for (const Triangle& t : s.triangles) EXPECT_EQ(t, (Triangle{0, 1, 2}));
}

TEST_F(TextFormats, ObjKeepsDoublePrecision) {
  const Surface s = read("far.obj", "v 5000000.125 0 0\nv 5000001.25 0 0\nv 5000000.125 1 0\nf 1 2 3\n");
  // As float they would be 0.125 and 0.25 off.
  EXPECT_NEAR(s.points[0].x, 5000000.125, 1e-8);
  EXPECT_NEAR(s.points[1].x, 5000001.25, 1e-8);
}

TEST_F(TextFormats, ObjLossesAreCounted) {
  const SurfaceSeries series = open_surface(
      {write("bad.obj",
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 2 9\nf 0 1 2\nf 1 2\n")});
  EXPECT_EQ(series.load(0).triangles.size(), 1u);
  EXPECT_EQ(series.load(0).points.size(), 3u);
  ASSERT_EQ(series.warnings.size(), 4u);
  EXPECT_TRUE(contains(series.warnings[0], "2 of 5 triangles dropped: point index out of range."));
  EXPECT_TRUE(contains(series.warnings[1], "1 of 5 triangles dropped: NaN or infinite point."));
  EXPECT_TRUE(contains(series.warnings[2], "1 of 5 triangles dropped: zero area."));
  EXPECT_TRUE(contains(series.warnings[3], "1 faces with fewer than 3 corners dropped."));
}

TEST_F(TextFormats, ObjFailuresAreClear) {
  EXPECT_TRUE(contains(failure("utf16.obj", std::string("\xff\xfev\0 \0", 6)), "UTF-16"));
  EXPECT_TRUE(contains(failure("points.obj", "v 0 0 0\n"), "1 points and no faces"));
  EXPECT_TRUE(contains(failure("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "zero area"));
  EXPECT_TRUE(contains(failure("empty.obj", ""), "it is empty"));
}

TEST_F(TextFormats, GzipIsUnpacked) {
  const fs::path path = folder_ / "cube.obj.gz";
  const gzFile file = gzopen(path.c_str(), "wb");
  const std::string text = cube_points + "f 1 2 3 4\n";
  gzwrite(file, text.data(), unsigned(text.size()));
  gzclose(file);
  EXPECT_EQ(open_surface({path}).load(0).triangles.size(), 2u);
  const std::string packed = read_all(path);
  EXPECT_TRUE(contains(failure("cut.obj.gz", packed.substr(0, packed.size() / 2)), "gzip"));
}

TEST_F(TextFormats, GzipBombIsRefused) {
  const fs::path path = folder_ / "bomb.obj.gz";
  const gzFile file = gzopen(path.c_str(), "wb6");
  const std::string zeros(1 << 20, '0');
  for (int i = 0; i < 24; ++i) gzwrite(file, zeros.data(), unsigned(zeros.size()));
  gzclose(file);
  EXPECT_TRUE(contains(failure({path}), "times its size"));
}

TEST_F(TextFormats, OffHeaders) {
  const std::string body = "0 0 0\n1 0 0 # corner\n\n0 1 0\n3 0 1 2 0.5 0.5 0.5\n";
  for (const char* header : {"OFF\n3 1 0\n", "OFF 3 1 3\n", "# first\nOFF\n# second\n3 1\n", "OFF3 1 3\n", "3 1 0\n"})
    EXPECT_EQ(read("header.off", header + body).triangles.size(), 1u) << header;
  const std::string coloured = "0 0 0 9 9 9 255\n1 0 0 9 9 9 255\n0 1 0 9 9 9 255\n3 0 1 2\n";
  for (const char* header : {"COFF\n3 1 0\n", "NOFF\n3 1 0\n", "STOFF\n3 1 0\n"})
    EXPECT_EQ(read("header.off", header + coloured).triangles.size(), 1u) << header;
}

TEST_F(TextFormats, OffFailuresAreClear) {
  EXPECT_TRUE(contains(failure("lie.off", "OFF\n4000000000 1 0\n0 0 0\n"), "more than the file can hold"));
  EXPECT_TRUE(contains(failure("four.off", "4OFF\n1 1 0\n"), "three-dimensional"));
  EXPECT_TRUE(contains(failure("binary.off", "OFF BINARY\n"), "binary OFF"));
  EXPECT_TRUE(contains(failure("short.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"), "point 3 of 3"));
}

std::string binary_stl(const std::string& header, const std::vector<std::array<Vec3f, 3>>& triangles) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes += bytes_of(std::uint32_t(triangles.size()));
  for (const auto& triangle : triangles) {
    bytes += std::string(12, '\0');
    for (const Vec3f& p : triangle) bytes += bytes_of(p.x) + bytes_of(p.y) + bytes_of(p.z);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

const std::vector<std::array<Vec3f, 3>> two_triangles = {{Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}},
                                                         {Vec3f{1, 0, -0.0f}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}}};

TEST_F(TextFormats, StlBinaryMergesCorners) {
  for (const char* header : {"made by hand", "solid but binary facet"}) {
    const Surface s = read("two.stl", binary_stl(header, two_triangles));
    EXPECT_EQ(s.points.size(), 4u);
    EXPECT_EQ(s.triangles.size(), 2u);
  }
  std::string lying = binary_stl("lie", two_triangles);
  lying[83] = '\x7f';
  EXPECT_TRUE(contains(failure("lie.stl", lying), "there are bytes for 2"));
}

TEST_F(TextFormats, StlTextWithSeveralSolids) {
  const std::string facet =
      "FACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\n";
  const Surface s = read("two.stl", "SOLID facet vertex one\n" + facet + "ENDSOLID\nsolid\nendsolid\nsolid two\n" +
                                        facet + "endsolid two\n");
  EXPECT_EQ(s.points.size(), 3u);
  EXPECT_EQ(s.triangles.size(), 2u);
  EXPECT_TRUE(contains(failure("cut.stl", "solid\n" + facet.substr(0, 60)), "cannot be read"));
}

/// A square of two triangles with a normal, a scalar and a vector on its points, in any encoding.
std::string ply(const std::string& format) {
  std::string text = "ply\nformat " + format +
                     " 1.0\ncomment a square\nelement vertex 4\nproperty double x\nproperty float y\nproperty float z\n"
                     "property uchar red\nproperty float p\nproperty float vx\nproperty float vy\nproperty float vz\n"
                     "element extra 2\nproperty list uchar short things\nelement face 2\n"
                     "property list uchar int vertex_indices\nproperty float quality\nend_header\n";
  const bool ascii = format == "ascii", big = format == "binary_big_endian";
  const auto put = [&](auto value) { text += ascii ? std::to_string(value) + " " : bytes_of(value, big); };
  for (int i = 0; i < 4; ++i) {
    put(double(i % 2)), put(float(i / 2)), put(0.0f), put(std::uint8_t(200)), put(float(i));
    put(1.0f), put(2.0f), put(float(10 * i));
  }
  put(std::uint8_t(2)), put(std::int16_t(7)), put(std::int16_t(-7)), put(std::uint8_t(0));
  const int faces[2][3] = {{0, 1, 3}, {0, 3, 2}};
  for (int f = 0; f < 2; ++f) {
    put(std::uint8_t(3));
    for (const int corner : faces[f]) put(std::int32_t(corner));
    put(float(f + 1));
  }
  return text;
}

TEST_F(TextFormats, PlyIsTheSameInEveryEncoding) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const Surface s = read("square.ply", ply(format));
    ASSERT_EQ(s.points.size(), 4u) << format;
    EXPECT_EQ(s.points[3], Vec3d(1, 1, 0));
    EXPECT_EQ(s.triangles[1], (Triangle{0, 3, 2}));
    ASSERT_EQ(s.arrays.size(), 3u);
    EXPECT_EQ(s.find("p")->values, (std::vector<float>{0, 1, 2, 3}));
    ASSERT_EQ(s.find("v")->components, 3);
    EXPECT_EQ(s.find("v")->values[11], 30);
    // Faces have equal areas: corners that share both have the mean, the others their own face's value.
    EXPECT_EQ(s.find("quality")->values, (std::vector<float>{1.5f, 1, 2, 1.5f}));
  }
}

TEST_F(TextFormats, PlyFailuresAreClear) {
  const std::string good = ply("binary_little_endian");
  std::string lie = good;
  lie.replace(lie.find("face 2"), 6, "face 2000000000");
  EXPECT_TRUE(contains(failure("lie.ply", lie), "more than the file can hold"));
  EXPECT_TRUE(contains(failure("cut.ply", good.substr(0, good.size() - 3)), "element 'face', 2 of 2"));
  EXPECT_TRUE(contains(failure("noend.ply", "ply\nformat ascii 1.0\n"), "header does not end"));
  EXPECT_TRUE(
      contains(failure("noxyz.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"),
               "x, y and z"));
}

TEST_F(TextFormats, PlyStripsTurnTheSameWay) {
  const Surface s =
      read("strip.ply",
           "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 2\n");
  ASSERT_EQ(s.triangles.size(), 3u);
  EXPECT_EQ(s.triangles[1], (Triangle{1, 3, 2}));
}

TEST_F(TextFormats, ContentDecidesWhereTheNameDoesNot) {
  EXPECT_EQ(read("square", ply("ascii")).triangles.size(), 2u);
  EXPECT_EQ(read("square.dat", ply("binary_big_endian")).triangles.size(), 2u);
  EXPECT_TRUE(contains(failure("square.stl", ply("ascii")), "looks like PLY"));
  EXPECT_TRUE(contains(failure("noise.dat", "nothing that we know"), "known format"));
  EXPECT_TRUE(contains(failure({folder_ / "missing.ply"}), "no such file"));
  EXPECT_TRUE(contains(failure({folder_.path()}), "folder"));
}

TEST_F(TextFormats, DescribeTellsWhatIsThere) {
  const FileInfo square = describe(write("square.ply", ply("ascii")));
  EXPECT_EQ(square.format, "PLY");
  EXPECT_EQ(square.kind, "surface");
  EXPECT_EQ(square.points, 4u);
  EXPECT_EQ(square.triangles, 2u);
  EXPECT_EQ(square.upper, Vec3d(1, 1, 0));
  ASSERT_EQ(square.arrays.size(), 3u);
  EXPECT_EQ(square.arrays[2].on, "cells");
  EXPECT_EQ(square.arrays[0].max, 3);
  EXPECT_EQ(describe(write("points.obj", "v 0 0 0\n")).kind, "points");
  EXPECT_EQ(describe(write("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")).kind, "lines");
  EXPECT_EQ(describe(write("none.stl", "solid none\nendsolid none\n")).kind, "unknown-empty");
}

}  // namespace
}  // namespace nacre::test
