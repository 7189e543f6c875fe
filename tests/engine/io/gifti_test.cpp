// Nacre: tests of GIFTI surfaces, and of the shapes and vectors on them.
#include <zlib.h>

#include "tests/engine/io/io_test_files.hpp"

namespace nacre::test {
namespace {

class Gifti : public ReaderTest {
 protected:
  static std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 3; ++k)
        bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
      for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    return text;
  }

  static std::string packed(const std::string& bytes) {
    uLongf size = compressBound(uLong(bytes.size()));
    std::string out(size, '\0');
    compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             uLong(bytes.size()));
    out.resize(size);
    return out;
  }

  /// `attributes` after the intent; the data as text.
  static std::string array(const std::string& intent, const std::string& attributes, const std::string& data,
                           const std::string& name = {}) {
    const std::string metadata = name.empty() ? ""
                                              : "<MetaData><MD><Name><![CDATA[Name]]></Name><Value><![CDATA[" + name +
                                                    "]]></Value></MD></MetaData>";
    return "<DataArray Intent=\"NIFTI_INTENT_" + intent + "\" " + attributes + ">" + metadata + "<Data>" + data +
           "</Data></DataArray>";
  }
  static std::string size(int rows, int columns) {
    return "Dimensionality=\"2\" Dim0=\"" + std::to_string(rows) + "\" Dim1=\"" + std::to_string(columns) +
           "\" ArrayIndexingOrder=\"RowMajorOrder\" ";
  }
  static std::string file(const std::string& arrays) {
    return "<?xml version=\"1.0\"?><!DOCTYPE GIFTI SYSTEM \"gifti.dtd\"><GIFTI Version=\"1.0\">" + arrays + "</GIFTI>";
  }

  static std::string floats() { return "DataType=\"NIFTI_TYPE_FLOAT32\" Encoding=\"ASCII\" "; }
  static std::string ints() { return "DataType=\"NIFTI_TYPE_INT32\" Encoding=\"ASCII\" "; }
  static std::string square() {
    return array("POINTSET", floats() + size(4, 3), "0 0 0 1 0 0 1 1 0 0 1 0") +
           array("TRIANGLE", ints() + size(2, 3), "0 1 2 0 2 3");
  }
};

TEST_F(Gifti, EveryEncodingAndByteOrder) {
  const std::vector<float> numbers = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  for (const bool big : {false, true}) {
    std::string bytes, corners;
    for (const float number : numbers) bytes += bytes_of(number, big);
    for (const int corner : {0, 1, 2, 0, 2, 3}) corners += bytes_of(std::int32_t(corner), big);
    const std::string order = big ? "Endian=\"BigEndian\" " : "Endian=\"LittleEndian\" ";
    for (const bool zip : {false, true}) {
      const std::string encoding = zip ? "Encoding=\"GZipBase64Binary\" " : "Encoding=\"Base64Binary\" ";
      const auto data = [&](const std::string& raw) { return base64(zip ? packed(raw) : raw); };
      const Surface surface = read(
          "a.surf.gii",
          file(array("POINTSET", "DataType=\"NIFTI_TYPE_FLOAT32\" " + encoding + order + size(4, 3), data(bytes)) +
               array("TRIANGLE", "DataType=\"NIFTI_TYPE_INT32\" " + encoding + order + size(2, 3), data(corners))));
      EXPECT_EQ(surface.triangles.size(), 2u);
      EXPECT_DOUBLE_EQ(area(surface), 1);
    }
  }
  EXPECT_DOUBLE_EQ(area(read("b.gii", file(square()))), 1);
}

TEST_F(Gifti, ArraysInTheSameFile) {
  const std::string column_major =
      "Dimensionality=\"2\" Dim0=\"4\" Dim1=\"3\" ArrayIndexingOrder=\"ColumnMajorOrder\" ";
  const Surface surface = read(
      "a.gii", file(square() + array("SHAPE", floats() + "Dimensionality=\"1\" Dim0=\"4\"", "1 2 3 4", "thickness") +
                    array("VECTOR", floats() + column_major, "1 2 3 4 5 6 7 8 9 10 11 12")));
  ASSERT_TRUE(surface.find("thickness") && surface.find("vector"));
  EXPECT_EQ(surface.find("thickness")->values, (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(surface.find("vector")->components, 3);
  EXPECT_EQ(surface.find("vector")->values[1], 5) << "y of the first point";
}

TEST_F(Gifti, ArraysInFilesOfTheirOwn) {
  const fs::path surface = write("a.surf.gii", file(square()));
  const auto shape = [](const std::string& values, int count) {
    return file(
        array("NONE", floats() + "Dimensionality=\"1\" Dim0=\"" + std::to_string(count) + "\"", values, "area"));
  };
  const SurfaceSeries both = open_surface({surface, write("a.shape.gii", shape("5 6 7 8", 4))});
  EXPECT_EQ(both.steps(), 1u);
  EXPECT_EQ(both.load(0).find("area")->values, (std::vector<float>{5, 6, 7, 8}));
  EXPECT_TRUE(contains(failure({surface, write("b.gii", shape("5 6", 2))}), "2 values for 4 points"));
  EXPECT_TRUE(
      contains(failure({write("c.gii", shape("5 6", 2)), write("d.gii", shape("5 6", 2))}), "the surface first"));
  EXPECT_EQ(open_surface({surface, surface}).steps(), 2u) << "two surfaces are two steps";
}

TEST_F(Gifti, ArraysOfOneNameAreStepsInTime) {
  std::string arrays = square();
  for (int t = 0; t < 3; ++t)
    arrays += array("TIME_SERIES", floats() + "Dimensionality=\"1\" Dim0=\"4\"", "1 2 3 " + std::to_string(t));
  const SurfaceSeries series = open_surface({write("a.gii", file(arrays))});
  EXPECT_EQ(series.steps(), 3u);
  EXPECT_EQ(series.load(2).find("time_series")->values[3], 2);
}

TEST_F(Gifti, WhatIsDamagedIsAnError) {
  const auto points = [&](const std::string& attributes, const std::string& data) {
    return failure("a.gii", file(array("POINTSET", attributes, data)));
  };
  const std::string binary = "DataType=\"NIFTI_TYPE_FLOAT32\" Encoding=\"Base64Binary\" Endian=\"LittleEndian\" ";
  const std::string zipped = "DataType=\"NIFTI_TYPE_FLOAT32\" Encoding=\"GZipBase64Binary\" Endian=\"LittleEndian\" ";
  EXPECT_TRUE(contains(failure("a.gii", file(square()).substr(0, 300)), "XML is damaged"));
  EXPECT_TRUE(contains(failure("a.gii", "<svg></svg>"), "not GIFTI"));
  EXPECT_TRUE(contains(points(floats() + size(4, 3), "0 0 0 1"), "cut short"));
  EXPECT_TRUE(contains(points(floats() + size(2, 2), "0 0 0 1"), "2 coordinates"));
  EXPECT_TRUE(contains(points(floats() + size(2000000000, 3), "0 0 0 1"), "cut short"));
  EXPECT_TRUE(contains(points(binary + size(2000000000, 3), base64("0123")), "cut short"));
  EXPECT_TRUE(contains(points(zipped + size(2000000000, 3), base64(packed("0123"))), "cut short"));
  EXPECT_TRUE(contains(points(zipped + size(4, 3), base64(packed("0123"))), "damaged"));
  EXPECT_TRUE(contains(points(zipped + size(4, 3), base64(std::string(100, 'x'))), "damaged"));
  EXPECT_TRUE(contains(points(binary + size(1, 3), "!!!!!!!!!!!!!!!!"), "not base64"));
  EXPECT_TRUE(contains(points(binary + size(-1, 3), ""), "Dim0"));
  EXPECT_TRUE(contains(points("Dimensionality=\"7\"", ""), "7 dimensions"));
  EXPECT_TRUE(contains(points("Encoding=\"ExternalFileBinary\" " + size(1, 3), ""), "another file"));
  EXPECT_TRUE(contains(
      points("DataType=\"NIFTI_TYPE_RGB24\" Encoding=\"Base64Binary\" " + size(1, 3), base64(std::string(12, 'x'))),
      "RGB24"));
  EXPECT_TRUE(contains(failure("a.gii", file(square() + square())), "several sets of points"));
}

}  // namespace
}  // namespace nacre::test
