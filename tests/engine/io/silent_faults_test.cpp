// Nacre: tests of files that could be read as something that they do not say: each gives a warning that names what is
// wrong, or an error.
#include <cmath>
#include <limits>

#include "engine/io/label_names.hpp"
#include "tests/engine/io/volume_files.hpp"

namespace nacre::test {
namespace {

class SilentSurface : public ReaderTest {
 protected:
  /// The warnings with which a file is opened, or the error, in one text.
  std::string said(const std::string& name, const std::string& content) const {
    std::string text;
    try {
      for (const std::string& warning : open_surface({write(name, content)}).warnings) text += warning + "\n";
    } catch (const Error& error) {
      text = error.what();
    }
    return text;
  }
};

class SilentVolume : public VolumeTest {
 protected:
  std::string said(const std::string& name, const std::string& content) const {
    std::string text;
    try {
      for (const std::string& warning : read(name, content).warnings) text += warning + "\n";
    } catch (const Error& error) {
      text = error.what();
    }
    return text;
  }
};

const std::string obj_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(SilentSurface, ObjIndicesThatAreNoIndices) {
  EXPECT_EQ(said("good.obj", obj_square + "f 1 2 3\nf +1/1 3//2 4/1/1\nf -4 -3 -2\n"), "");
  // The first would be point 1 if it were cut to 32 bits, the second if it were cut to 64.
  for (const char* word : {"4294967297", "18446744073709551617", "1.5", "1x", "-99999999999999999999", "x"})
    EXPECT_TRUE(contains(said("bad.obj", obj_square + "f 1 2 3\nf " + word + " 3 4\n"),
                         "1 of 2 triangles dropped: point index out of range"))
        << word;
}

TEST_F(SilentSurface, ObjCoordinatesThatAreNoNumbers) {
  for (const char* word : {"1-2", "1.2.3", "1e", "--1", "1e+-2"})
    EXPECT_TRUE(
        contains(said("bad.obj", obj_square + "v 2 2 " + word + "\nf 1 2 3\nf 1 2 5\n"), "NaN or infinite point"))
        << word;
  EXPECT_EQ(said("good.obj", "v .5 -1. +1e-3\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"), "");
}

TEST_F(SilentSurface, OffAndPlyWithMoreThanTheirHeadersSay) {
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  EXPECT_TRUE(contains(said("more.off", "OFF\n4 1 0\n" + points + "3 0 1 2\n3 0 2 3\n"), "4 points and 1 faces"));
  EXPECT_TRUE(contains(said("count.off", "OFF4x 1 0\n" + points + "3 0 1 2\n"), "not an OFF header"));
  EXPECT_EQ(said("good.off", "OFF4 1 0\n" + points + "3 0 1 2\n# the end\n"), "");
  const auto ply = [&](const std::string& faces, const std::string& body) {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement "
           "face " +
           faces + "\nproperty list uchar int vertex_indices\nend_header\n" + points + body;
  };
  EXPECT_EQ(said("good.ply", ply("1", "3 0 1 2\n")), "");
  EXPECT_TRUE(contains(said("more.ply", ply("1", "3 0 1 2\n3 0 2 3\n")), "What follows"));
  EXPECT_TRUE(contains(said("count.ply", ply("1x", "3 0 1 2\n")), "has no count"));
  EXPECT_TRUE(contains(said("length.ply", ply("1", "3.5 0 1 2\n")), "damaged in element 'face'"));
}

TEST_F(SilentSurface, StlFacetsWithoutEndOfLoop) {
  const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex ";
  const std::string text = "solid a\n" + facet + "1 1 0\nendfacet\n" + facet + "0 1 0\nendloop\nendfacet\nendsolid a\n";
  EXPECT_EQ(read("loop.stl", text).triangles.size(), 2u);
}

/// A square of two triangles; the attributes of its file, of its arrays, and what the counts of its piece are.
std::string square_vtp(const std::string& file, const std::string& array, const std::string& counts = "",
                       const std::string& more_points = "") {
  return "<VTKFile type=\"PolyData\" " + file + "><PolyData><Piece " +
         (counts.empty() ? "NumberOfPoints=\"4\" NumberOfPolys=\"2\"" : counts) +
         "><PointData><DataArray type=\"Float32\" Name=\"v\" format=\"ascii\" " + array +
         ">1 2 3 4 5 6 7 8 9 10 11 12</DataArray></PointData><Points><DataArray type=\"Float32\" "
         "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0 0 1 0 " +
         more_points +
         "</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 0 2 "
         "3</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3 6</DataArray></Polys></Piece>"
         "</PolyData></VTKFile>";
}

TEST_F(SilentSurface, VtkAttributesThatCannotBe) {
  const std::string three = "NumberOfComponents=\"3\"";
  EXPECT_EQ(said("good.vtp", square_vtp("byte_order=\"LittleEndian\" header_type=\"UInt32\"", three)), "");
  for (const char* components : {"-3", "3x", "three", "99999999999"})
    EXPECT_TRUE(contains(said("c.vtp", square_vtp("", std::string("NumberOfComponents=\"") + components + "\"")),
                         std::string("array 'v' has ") + components + " components"))
        << components;
  EXPECT_TRUE(contains(said("h.vtp", square_vtp("header_type=\"UInt16\"", three)), "header_type is 'UInt16'"));
  EXPECT_TRUE(
      contains(said("b.vtp", square_vtp("byte_order=\"MiddleEndian\"", three)), "byte_order is 'MiddleEndian'"));
  EXPECT_TRUE(
      contains(said("n.vtp", square_vtp("", three, "NumberOfPoints=\"4x\" NumberOfPolys=\"2\"")), "not a count"));
  EXPECT_TRUE(contains(said("p.vtp", square_vtp("", three, "", "5 5 5")), "'Points' has 5 entries"));
  EXPECT_TRUE(contains(said("a.vtp", square_vtp("", "NumberOfComponents=\"2\"")), "'v' has 6 entries"));
  EXPECT_TRUE(contains(said("o.vtp", square_vtp("", three, "NumberOfPoints=\"4\" NumberOfPolys=\"1\"")),
                       "'offsets' has 2 entries"));
}

TEST_F(SilentSurface, GiftiArraysOfAnotherSize) {
  const auto file = [](const std::string& points, const std::string& triangles, const std::string& root = "") {
    return "<?xml version=\"1.0\"?><GIFTI " + root +
           "><DataArray Intent=\"NIFTI_INTENT_POINTSET\" DataType=\"NIFTI_TYPE_FLOAT32\" Encoding=\"ASCII\" "
           "Dimensionality=\"2\" Dim0=\"3\" Dim1=\"3\"><Data>" +
           points +
           "</Data></DataArray><DataArray Intent=\"NIFTI_INTENT_TRIANGLE\" DataType=\"NIFTI_TYPE_FLOAT32\" "
           "Encoding=\"ASCII\" Dimensionality=\"2\" Dim0=\"1\" Dim1=\"3\"><Data>" +
           triangles + "</Data></DataArray></GIFTI>";
  };
  const std::string points = "0 0 0 1 0 0 1 1 0";
  EXPECT_EQ(said("good.gii", file(points, "0 1 2", "NumberOfDataArrays=\"2\"")), "");
  EXPECT_TRUE(contains(said("more.gii", file(points + " 5", "0 1 2")), "more values than its size"));
  EXPECT_TRUE(contains(said("real.gii", file(points, "0 1 1.5")), "point index out of range"));
  EXPECT_TRUE(
      contains(said("arrays.gii", file(points, "0 1 2", "NumberOfDataArrays=\"3\"")), "it has 3 arrays, and has 2"));
}

/// NIfTI-1 of 3 x 2 x 2 bytes: float fields by offset.
std::string nifti(const std::vector<std::pair<std::size_t, float>>& fields, std::int16_t bits = 8,
                  const std::string& more = "") {
  std::string bytes(352, '\0');
  const auto put = [&](std::size_t at, const std::string& number) { bytes.replace(at, number.size(), number); };
  put(0, bytes_of(std::int32_t(348)));
  for (std::size_t i = 0; i < 8; ++i) put(40 + 2 * i, bytes_of(std::array<std::int16_t, 8>{3, 3, 2, 2, 1, 1, 1, 1}[i]));
  put(70, bytes_of(std::int16_t(2)));
  put(72, bytes_of(bits));
  for (std::size_t i = 0; i < 4; ++i) put(76 + 4 * i, bytes_of(1.0f));
  put(108, bytes_of(352.0f));
  put(252, bytes_of(std::int16_t(1)));  // qform
  put(344, std::string("n+1\0", 4));
  for (const auto& [at, value] : fields) put(at, bytes_of(value));
  return bytes + counting<std::uint8_t>(12) + more;
}

TEST_F(SilentVolume, NiftiFieldsThatAreNoNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(said("good.nii", nifti({})), "");
  EXPECT_EQ(said("scaled.nii", nifti({{112, 2.0f}, {116, 1.0f}})), "");
  for (const float slope : {nan, inf, -inf})
    EXPECT_TRUE(contains(said("slope.nii", nifti({{112, slope}})), "scl_slope is"));
  EXPECT_EQ(values_of(read("slope.nii", nifti({{112, inf}, {116, 7.0f}}))), count_up(12));  // as they are stored
  for (const float intercept : {nan, inf})
    EXPECT_TRUE(contains(said("inter.nii", nifti({{112, 2.0f}, {116, intercept}})), "scl_inter is"));
  EXPECT_EQ(said("unused.nii", nifti({{116, nan}})), "");  // without a slope, nothing is added
  // The library takes NaN for 0, and makes a quaternion that is too long one of length 1.
  for (const std::size_t field : {256, 264, 268, 276})
    EXPECT_TRUE(contains(said("q.nii", nifti({{field, nan}})), "its qform")) << field;
  EXPECT_TRUE(contains(said("long.nii", nifti({{256, 3.0f}})), "its qform"));
}

TEST_F(SilentVolume, NiftiSizesThatDisagree) {
  EXPECT_TRUE(contains(said("bits.nii", nifti({}, 16)), "16 bits per voxel, but its type has 8"));
  EXPECT_TRUE(contains(said("more.nii", nifti({}, 8, "x")), "go on after the last voxel"));
  EXPECT_EQ(said("good.nii.gz", gzipped(nifti({}))), "");
  EXPECT_TRUE(contains(said("raw.nii.gz", nifti({})), "raw.nii.gz is not packed with gzip, although its name says so"));
}

/// Teem would write beyond the buffer of a message.
TEST_F(SilentVolume, NrrdLinesThatAreTooLongForMessages) {
  const std::string begin = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: 1 1 1\nencoding: raw\n";
  const std::string end = "\n\nabcdefgh";
  const std::string many(5000, 'y');
  EXPECT_EQ(said("key.nrrd", begin + "key:=" + many + "\n# " + many + end), "");
  for (const std::string& line : {many, "content: " + many, "kinds: " + many, many + ": 1", "a: b:=" + many})
    EXPECT_TRUE(contains(said("long.nrrd", begin + line + end), "line 7 of its header has 50")) << line.substr(0, 20);
  EXPECT_TRUE(contains(said("long.nrrd", "NRRD0004" + many + end), "line 1 of its header has 50"));
}

TEST_F(SilentVolume, NrrdThatSaysGzipOverRawData) {
  const auto nrrd = [](const std::string& encoding, const std::string& more) {
    return "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nspacings: 1 1 1\nencoding: " + encoding + "\n" + more;
  };
  const std::string data = counting<std::uint8_t>(12);
  EXPECT_EQ(said("good.nrrd", nrrd("gzip", "\n" + gzipped(data))), "");
  EXPECT_EQ(said("raw.nrrd", nrrd("raw", "\n" + data)), "");
  EXPECT_TRUE(contains(said("lie.nrrd", nrrd("gzip", "\n" + data)), "not packed with gzip, although its header"));
  write("data.raw", data);
  EXPECT_TRUE(contains(said("lie.nhdr", nrrd("gzip", "data file: data.raw\n")), "data.raw is not packed with gzip"));
  EXPECT_TRUE(contains(said("more.nrrd", nrrd("raw", "\n" + data + "x")), "go on after the last voxel"));
}

TEST_F(SilentVolume, MetaImageWordsAndSizes) {
  const auto meta = [](const std::string& fields) {
    return "NDims = 3\nDimSize = 3 2 2\nElementSpacing = 1 1 1\n" + fields +
           "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + counting<std::uint8_t>(12);
  };
  EXPECT_EQ(said("good.mha", meta("BinaryData = True\nCompressedData = False\n")), "");
  EXPECT_TRUE(contains(said("word.mha", meta("CompressedData = maybe\n")), "CompressedData = maybe"));
  EXPECT_TRUE(contains(said("packed.mha", meta("CompressedData = True\n")), "packed values are damaged"));
  EXPECT_TRUE(contains(said("more.mha", meta("") + "x"), "go on after the last voxel"));
  EXPECT_TRUE(contains(said("rank.mha", "NDims = 3 4\n" + meta("").substr(10)), "NDims = 3 4"));
}

TEST_F(SilentVolume, InrFreeSurferAndVti) {
  std::string inr =
      "#INRIMAGE-4#{\nXDIM=3\nYDIM=2\nZDIM=2\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=pc\nVX=1\n"
      "VY=1\nVZ=1\n";
  inr += std::string(256 - 4 - inr.size(), '\n') + "##}\n" + counting<std::uint8_t>(12);
  EXPECT_EQ(said("good.inr", inr), "");
  EXPECT_TRUE(contains(said("more.inr", inr + "x"), "go on after the last voxel"));
  EXPECT_TRUE(contains(said("raw.inr.gz", inr), "not packed with gzip"));
  std::string two = inr;
  two.replace(two.find("YDIM=2\n"), 7, " 9\nYDIM=2\n");  // "XDIM=3\n 9": its own line, without a meaning
  two.replace(two.find("XDIM=3\n"), 7, "XDIM=3 ");
  EXPECT_TRUE(contains(said("two.inr", two), "XDIM=3"));

  std::string mgh = bytes_of(std::int32_t(1), true);
  for (const std::int32_t number : {3, 2, 2, 1, 0, 0}) mgh += bytes_of(number, true);
  mgh.resize(284, '\0');
  mgh += counting<std::uint8_t>(12);
  EXPECT_FALSE(contains(said("a.mgh", mgh), "gzip"));
  EXPECT_FALSE(contains(said("a.mgz", gzipped(mgh)), "gzip"));
  EXPECT_TRUE(contains(said("raw.mgz", mgh), "not packed with gzip"));

  const auto vti = [](const std::string& grid, const std::string& array, const std::string& numbers) {
    return "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\" " + grid +
           "><Piece Extent=\"0 1 0 1 0 1\"><PointData><DataArray Name=\"a\" format=\"ascii\" " + array + ">" + numbers +
           "</DataArray></PointData></Piece></ImageData></VTKFile>";
  };
  const std::string good = "Spacing=\"1 1 1\"", type = "type=\"Int16\"", eight = "1 2 3 4 5 6 7 8";
  EXPECT_EQ(said("good.vti", vti(good, type, eight)), "");
  EXPECT_TRUE(contains(said("s.vti", vti("Spacing=\"1 1\"", type, eight)), "Spacing is '1 1', not 3 numbers"));
  EXPECT_TRUE(contains(said("o.vti", vti(good + " Origin=\"0 0 x\"", type, eight)), "Origin is '0 0 x'"));
  EXPECT_TRUE(contains(said("m.vti", vti(good, type, eight + " 9")), "'a' has 9 entries"));
  EXPECT_TRUE(contains(said("c.vti", vti(good, type + " NumberOfComponents=\"-3\"", eight)), "'a' has -3 components"));
}

TEST_F(SilentVolume, LabelNumbersThatAreNone) {
  for (const char* line : {"99999999999999999999 liver", "5.5 liver"}) {
    std::string why;
    try {
      read_label_names(write("labels.txt", std::string("1 spleen\n") + line + "\n"));
    } catch (const Error& error) {
      why = error.what();
    }
    EXPECT_TRUE(contains(why, "line 2 is not a number and a name")) << line;
  }
}

}  // namespace
}  // namespace nacre::test
