// Nacre: tests of the surface writers, against bytes worked out by hand.
#include "engine/io/surface_writer.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "compute/device/error.hpp"
#include "engine/io/vtp_writer.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

using test::read_all;
using test::TemporaryFolder;

Surface two_triangles() {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.1, 0.25, 1e10}};
  s.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.arrays = {{"p", 1, {1, 2, 3, 4}}, {"a <b> \"c\"", 3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}};
  return s;
}

/// The first bytes that a base64 text stands for.
std::string decoded(const std::string& text, std::size_t bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  for (std::size_t i = 0; out.size() < bytes && i < text.size(); ++i) {
    bits = bits << 6 | unsigned(text[i] == '=' ? 0 : digits.find(text[i]));
    if (i % 4 == 0) continue;
    out += char(bits >> (6 - 2 * (i % 4)) & 255);
  }
  return out;
}

/// The block of the array called `name` in a .vtp: type, components, values.
template <class T>
std::vector<T> block(const std::string& file, const std::string& name, const std::string& type, int components) {
  const std::size_t found = file.find("Name=\"" + name + "\"");
  if (found == std::string::npos) return {};
  const std::string element = file.substr(file.rfind('<', found), file.find('>', found) - file.rfind('<', found));
  EXPECT_NE(element.find("type=\"" + type + "\""), std::string::npos) << element;
  EXPECT_NE(element.find("NumberOfComponents=\"" + std::to_string(components) + "\""), std::string::npos) << element;
  EXPECT_NE(element.find("format=\"binary\""), std::string::npos) << element;
  const std::size_t begin = file.find('>', found) + 1;
  const std::string text = file.substr(begin, file.find('<', begin) - begin);
  std::uint64_t bytes;
  std::memcpy(&bytes, decoded(text, 8).data(), 8);
  std::vector<T> values(bytes / sizeof(T));
  std::memcpy(values.data(), decoded(text, 8 + bytes).data() + 8, bytes);
  return values;
}

TEST(VtpWriter, BlocksAreWithinTheirElements) {
  const TemporaryFolder folder;
  const Surface s = two_triangles();
  write_surface(folder / "a.vtp", s, 2.5);
  const std::string file = read_all(folder / "a.vtp");
  EXPECT_NE(file.find("NumberOfPoints=\"4\" NumberOfVerts=\"0\""), std::string::npos);
  EXPECT_NE(file.find("NumberOfPolys=\"2\""), std::string::npos);
  EXPECT_NE(file.find(">2.5</DataArray>"), std::string::npos);
  EXPECT_EQ(block<double>(file, "Points", "Float64", 3),
            (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0.1, 0.25, 1e10}));
  EXPECT_EQ(block<float>(file, "p", "Float32", 1), s.arrays[0].values);
  EXPECT_EQ(block<float>(file, "a &lt;b&gt; &quot;c&quot;", "Float32", 3), s.arrays[1].values);
  EXPECT_EQ(block<std::uint32_t>(file, "connectivity", "UInt32", 1), (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(block<std::int32_t>(file, "offsets", "Int32", 1), (std::vector<std::int32_t>{3, 6}));
  EXPECT_TRUE(file.ends_with("</VTKFile>\n"));
}

TEST(VtpWriter, FilesAreXmlToTheLastByte) {
  const TemporaryFolder folder;
  Surface s = two_triangles();
  s.arrays[0].values = {1e-38f, -3.7e20f, 0, 123456};  // bytes of all kinds
  write_surface(folder / "a.vtp", s, 2.5);
  for (const char c : read_all(folder / "a.vtp")) ASSERT_TRUE((c >= ' ' && c <= '~') || c == '\n') << int(c);
}

TEST(VtpWriter, PointsWithoutTrianglesBecomeVertices) {
  const TemporaryFolder folder;
  std::vector<Vec3f> points(100000);  // more than one buffer of generated indices
  points[1] = {1, 2, 3};
  const std::vector<PointArray> arrays = {{"value", 1, std::vector<float>(points.size(), 0.5f)}};
  write_vtp(folder / "a.vtp", std::span<const Vec3f>(points), {}, arrays);
  const std::string file = read_all(folder / "a.vtp");
  EXPECT_NE(file.find("NumberOfVerts=\"100000\""), std::string::npos);
  EXPECT_EQ(file.find("TimeValue"), std::string::npos);
  const auto connectivity = block<std::int32_t>(file, "connectivity", "Int32", 1);
  const auto offsets = block<std::int32_t>(file, "offsets", "Int32", 1);
  ASSERT_EQ(connectivity.size(), points.size());
  ASSERT_EQ(offsets.size(), points.size());
  for (int i = 0; i < 100000; ++i) ASSERT_TRUE(connectivity[i] == i && offsets[i] == i + 1) << i;
  EXPECT_EQ(block<float>(file, "Points", "Float32", 3)[5], 3);
}

TEST(VtpWriter, ArrayOfAnotherLengthIsAnError) {
  const TemporaryFolder folder;
  Surface s = two_triangles();
  s.arrays[0].values.pop_back();
  for (const std::string name : {"a.vtp", "a.ply"}) EXPECT_THROW(write_surface(folder / name, s), Error);
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(SurfaceWriter, ObjAndOffAreTextThatReadsBackExactly) {
  const TemporaryFolder folder;
  Surface s = two_triangles();
  s.points[1].x = 0.1f;     // was a float: written as one
  s.points[2].x = 1.0 / 3;  // was not
  write_surface(folder / "a.obj", s);
  write_surface(folder / "a.off", s);
  EXPECT_EQ(read_all(folder / "a.obj"),
            "v 0 0 0\nv 0.1 0 0\nv 0.3333333333333333 1 0\nv 0.1 0.25 10000000000\nf 1 2 3\nf 1 3 4\n");
  EXPECT_EQ(read_all(folder / "a.off"),
            "OFF\n4 2 0\n0 0 0\n0.1 0 0\n0.3333333333333333 1 0\n0.1 0.25 10000000000\n3 0 1 2\n3 0 2 3\n");
}

TEST(SurfaceWriter, StlHasNormalsAndTheRightSize) {
  const TemporaryFolder folder;
  write_surface(folder / "a.STL", two_triangles());
  const std::string file = read_all(folder / "a.STL");
  ASSERT_EQ(file.size(), 84u + 2 * 50u);
  EXPECT_FALSE(file.starts_with("solid"));
  std::uint32_t count;
  float first[12];
  std::memcpy(&count, &file[80], 4);
  std::memcpy(first, &file[84], 48);
  EXPECT_EQ(count, 2u);
  const float expected[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0};
  for (int i = 0; i < 12; ++i) EXPECT_EQ(first[i], expected[i]);
}

TEST(SurfaceWriter, PlyKeepsArraysUnderUsableNames) {
  const TemporaryFolder folder;
  Surface s = two_triangles();
  s.arrays.push_back({"x", 1, {5, 6, 7, 8}});  // the name of a coordinate
  write_surface(folder / "a.ply", s);
  const std::string file = read_all(folder / "a.ply");
  EXPECT_NE(file.find("property float p\nproperty float a_<b>_\"c\"_x\n"), std::string::npos);
  EXPECT_NE(file.find("property float x_\n"), std::string::npos);
  const std::size_t body = file.find("end_header\n") + 11;
  ASSERT_EQ(file.size(), body + 4 * (24 + 5 * 4) + 2 * 13);
  float values[5];
  std::memcpy(values, &file[body + 44 + 24], 20);  // the second vertex
  EXPECT_EQ(values[0], 2);
  EXPECT_EQ(values[1], 3);
  EXPECT_EQ(values[4], 6);
}

TEST(SurfaceWriter, OtherExtensionsAndBadIndicesAreErrors) {
  const TemporaryFolder folder;
  Surface s = two_triangles();
  EXPECT_THROW(write_surface(folder / "a.xyz", s), Error);
  EXPECT_THROW(write_surface(folder / "a", s), Error);
  s.triangles[1].c = 4;
  for (const std::string& extension : surface_writer_extensions())
    EXPECT_THROW(write_surface(folder / ("a" + extension), s), Error);
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(SeriesWriter, StepsThenIndex) {
  const TemporaryFolder folder;
  SurfaceSeries series{"s",
                       {0, 0.1, 0.2},
                       [](std::size_t k) {
                         Surface s = two_triangles();
                         s.points[0].x = double(k);
                         return s;
                       },
                       {}};
  const auto files = write_series(folder / "run.pvd", series);
  ASSERT_EQ(files.size(), 4u);
  EXPECT_EQ(files[2], folder / "run_0002.vtp");
  EXPECT_EQ(block<double>(read_all(files[2]), "Points", "Float64", 3)[0], 2);
  const std::string index = read_all(files[3]);
  EXPECT_NE(index.find("timestep=\"0.1\" group=\"\" part=\"0\" file=\"run_0001.vtp\""), std::string::npos);
}

TEST(SeriesWriter, FailureLeavesNothing) {
  const TemporaryFolder folder;
  SurfaceSeries series{"s",
                       {0, 1},
                       [](std::size_t k) {
                         if (k == 1) throw Error("step 1 is broken");
                         return two_triangles();
                       },
                       {}};
  EXPECT_THROW(write_series(folder / "run.pvd", series), Error);
  EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace nacre
