// Nacre: tests of the VTK XML readers: encodings, cells, pieces.
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "engine/io/vtk_image.hpp"
#include "tests/engine/io/io_test_files.hpp"

namespace nacre::test {
namespace {

class VtkXml : public ReaderTest {};

std::string base64(const std::string& bytes) {
  static const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (int k = 0; k < 4; ++k) text += i + std::size_t(k) > bytes.size() ? '=' : alphabet[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

/// How a test file stores its arrays.
struct Encoding {
  enum class Where { ascii, inline_base64, appended_raw, appended_base64 } where = Where::ascii;
  bool zlib = false, wide_header = false, big = false;
  std::size_t block_values = 4;  ///< values per zlib block: small, so that there are several
};

/// Builds the arrays of a VTK XML file one after the other.
class Writer {
 public:
  explicit Writer(Encoding encoding) : encoding_(encoding) {}

  template <class T>
  std::string array(const char* type, const std::string& name, int components, const std::vector<T>& values) {
    std::string tag = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                      std::to_string(components) + "\" format=\"";
    if (encoding_.where == Encoding::Where::ascii) {
      tag += "ascii\">";
      for (const T value : values) tag += std::to_string(value) + "\n ";
      return tag + "</DataArray>\n";
    }
    std::string header, data;
    if (encoding_.zlib)
      pack(values, header, data);
    else {
      for (const T value : values) data += bytes_of(value, encoding_.big);
      header = count(data.size());
    }
    if (encoding_.where == Encoding::Where::inline_base64)
      return tag + "binary\">\n  " + text(header, data) + "\n</DataArray>\n";
    tag += "appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
    appended_ += encoding_.where == Encoding::Where::appended_raw ? header + data : text(header, data);
    return tag;
  }

  std::string file(const std::string& type, const std::string& content) const {
    std::string xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type + "\" version=\"1.0\" byte_order=\"" +
                      (encoding_.big ? "BigEndian" : "LittleEndian") + "\"";
    if (encoding_.wide_header) xml += " header_type=\"UInt64\"";
    if (encoding_.zlib) xml += " compressor=\"vtkZLibDataCompressor\"";
    xml += "><" + type + ">" + content + "</" + type + ">";
    if (encoding_.where == Encoding::Where::appended_raw)
      xml += "<AppendedData encoding=\"raw\">\n _" + appended_ + "\n</AppendedData>";
    if (encoding_.where == Encoding::Where::appended_base64)
      xml += "<AppendedData encoding=\"base64\">_" + appended_ + "</AppendedData>";
    return xml + "</VTKFile>";
  }

 private:
  std::string count(std::size_t value) const {
    return encoding_.wide_header ? bytes_of(std::uint64_t(value), encoding_.big)
                                 : bytes_of(std::uint32_t(value), encoding_.big);
  }

  /// VTK encodes the header of packed data by itself, and that of plain data together with them.
  std::string text(const std::string& header, const std::string& data) const {
    return encoding_.zlib ? base64(header) + base64(data) : base64(header + data);
  }

  template <class T>
  void pack(const std::vector<T>& values, std::string& header, std::string& data) const {
    const std::size_t block = encoding_.block_values, blocks = (values.size() + block - 1) / block;
    const std::size_t last = values.size() % block;
    header = count(blocks) + count(block * sizeof(T)) + count(last * sizeof(T));
    for (std::size_t b = 0; b < blocks; ++b) {
      std::string plain;
      for (std::size_t i = b * block; i < std::min(values.size(), (b + 1) * block); ++i)
        plain += bytes_of(values[i], encoding_.big);
      std::string packed(compressBound(plain.size()), '\0');
      uLongf size = packed.size();
      compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(plain.data()),
               plain.size());
      header += count(size);
      data += packed.substr(0, size);
    }
  }

  Encoding encoding_;
  std::string appended_;
};

/// A vertex, a line, a quad and a strip of two triangles, with data on points and cells.
std::string mixed_vtp(Writer& w) {
  std::string c =
      "<FieldData>" + w.array<float>("Float32", "TimeValue", 1, {0.25f}) + "</FieldData>" +
      "<Piece NumberOfPoints=\"6\" NumberOfVerts=\"1\" NumberOfLines=\"1\" NumberOfStrips=\"1\" NumberOfPolys=\"1\">";
  c += "<PointData>" +
       w.array<double>("Float64", "u", 3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}) +
       w.array<std::int16_t>("Int16", "id", 1, {0, -1, -2, -3, -4, -5}) + "</PointData>";
  c += "<CellData>" + w.array<std::uint8_t>("UInt8", "c", 1, {100, 101, 8, 4}) + "</CellData>";
  c += "<Points>" + w.array<float>("Float32", "Points", 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0}) +
       "</Points>";
  c += "<Verts>" + w.array<std::int64_t>("Int64", "connectivity", 1, {0}) +
       w.array<std::int64_t>("Int64", "offsets", 1, {1}) + "</Verts>";
  c += "<Lines>" + w.array<std::int32_t>("Int32", "connectivity", 1, {0, 1}) +
       w.array<std::int32_t>("Int32", "offsets", 1, {2}) + "</Lines>";
  c += "<Polys>" + w.array<std::int32_t>("Int32", "connectivity", 1, {0, 1, 2, 3}) +
       w.array<std::int32_t>("Int32", "offsets", 1, {4}) + "</Polys>";
  c += "<Strips>" + w.array<std::uint64_t>("UInt64", "connectivity", 1, {1, 4, 2, 5}) +
       w.array<std::int64_t>("Int64", "offsets", 1, {4}) + "</Strips></Piece>";
  return w.file("PolyData", c);
}

TEST_F(VtkXml, EveryEncodingReadsTheSame) {
  using Where = Encoding::Where;
  for (const Where where : {Where::ascii, Where::inline_base64, Where::appended_raw, Where::appended_base64})
    for (const bool zlib : {false, true})
      for (const bool wide : {false, true})
        for (const bool big : {false, true}) {
          Writer writer({where, zlib, wide, big});
          const Surface s = read("mixed.vtp", mixed_vtp(writer));
          SCOPED_TRACE(int(where) * 8 + zlib * 4 + wide * 2 + big);
          ASSERT_EQ(s.points.size(), 6u);
          ASSERT_EQ(s.triangles.size(), 4u);
          EXPECT_EQ(s.triangles[2], (Triangle{1, 4, 2}));
          EXPECT_EQ(s.triangles[3], (Triangle{4, 5, 2}));
          EXPECT_EQ(s.find("u")->values[17], 17);
          EXPECT_EQ(s.find("id")->values[5], -5);
          EXPECT_EQ(s.find("c")->values[0], 8);  // the quad alone
          EXPECT_EQ(s.find("c")->values[5], 4);  // the strip alone
        }
}

TEST_F(VtkXml, DamagedArraysAreErrors) {
  Writer writer({Encoding::Where::appended_raw, true});
  const std::string good = mixed_vtp(writer);
  std::string damaged = good;
  damaged[good.find("_") + 30] ^= 0x55;
  EXPECT_TRUE(contains(failure("damaged.vtp", damaged), "cannot be read"));
  EXPECT_TRUE(contains(failure("cut.vtp", good.substr(0, good.find("_") + 100)), "cannot be read"));
  std::string lz4 = good;
  lz4.replace(lz4.find("vtkZLib"), 7, "vtkLZ4");
  EXPECT_TRUE(contains(failure("lz4.vtp", lz4), "vtkLZ4DataCompressor"));
  std::string lie = good;
  lie.replace(lie.find("Points=\"6\""), 10, "Points=\"9000000000000\"");
  EXPECT_TRUE(contains(failure("lie.vtp", lie), "is not a count"));
  lie.replace(lie.find("9000000000000"), 13, "900000000");
  EXPECT_TRUE(contains(failure("lie.vtp", lie), "promises 900000000 points"));
  Writer plain({Encoding::Where::appended_base64});
  std::string beyond = mixed_vtp(plain);
  const std::size_t data = beyond.find('_') + 1, end = beyond.find("</AppendedData>");
  const std::size_t first = beyond.find("offset=\"0\"");
  beyond.replace(first, 10, "offset=\"" + std::to_string(end - data) + "\"");
  EXPECT_TRUE(contains(failure("beyond.vtp", beyond), "lies beyond its end"));
}

TEST_F(VtkXml, SizesOfPackedBlocksThatLieAreErrors) {
  Writer writer({Encoding::Where::appended_raw, true, true});
  const std::string good = mixed_vtp(writer);
  const std::size_t begin = good.find("\n _") + 3;
  for (std::uint64_t first = 1; first < good.size(); first += 4) {
    std::string lie = good;
    const std::uint64_t lies[] = {2, 16, 16, first, std::uint64_t(1) << 60};  // blocks, sizes unpacked, sizes packed
    std::memcpy(lie.data() + begin, lies, sizeof lies);
    EXPECT_TRUE(contains(failure("lie.vtp", lie), "cut short")) << first;
  }
}

std::string grid(Writer& w, const std::vector<float>& points, const std::vector<std::int64_t>& connectivity,
                 const std::vector<std::int64_t>& offsets, const std::vector<std::uint8_t>& types,
                 const std::string& more_cells = {}) {
  std::vector<float> numbers;
  for (std::size_t i = 0; i < types.size(); ++i) numbers.push_back(float(i));
  std::string c = "<Piece NumberOfPoints=\"" + std::to_string(points.size() / 3) + "\" NumberOfCells=\"" +
                  std::to_string(types.size()) + "\"><CellData>" + w.array("Float32", "number", 1, numbers) +
                  "</CellData><Points>" + w.array("Float32", "Points", 3, points) + "</Points><Cells>" +
                  w.array("Int64", "connectivity", 1, connectivity) + w.array("Int64", "offsets", 1, offsets) +
                  w.array("UInt8", "types", 1, types) + more_cells + "</Cells></Piece>";
  return w.file("UnstructuredGrid", c);
}

// Two unit cubes side by side along x, as 12 points.
const std::vector<float> two_cubes = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0,
                                      0, 0, 1, 1, 0, 1, 2, 0, 1, 0, 1, 1, 1, 1, 1, 2, 1, 1};

TEST_F(VtkXml, VolumeCellsGiveTheirOuterSurface) {
  Writer w({});
  // A hexahedron beside a voxel: they share one face.
  const Surface s =
      read("two.vtu", grid(w, two_cubes, {0, 1, 4, 3, 6, 7, 10, 9, 1, 2, 4, 5, 7, 8, 10, 11}, {8, 16}, {12, 11}));
  EXPECT_EQ(s.triangles.size(), 20u);
  EXPECT_DOUBLE_EQ(area(s), 10);
  EXPECT_NEAR(volume(s), 2, 1e-12);
  EXPECT_EQ(s.find("number")->values[0], 0);
  EXPECT_EQ(s.find("number")->values[2], 1);
}

TEST_F(VtkXml, EachVolumeCellFacesOutwards) {
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1,   0,   0, 0,
                                      1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 0.5, 0.5, 1};
  const struct {
    std::vector<std::int64_t> cell;
    std::uint8_t type;
    double volume;
  } cases[] = {{{0, 1, 3, 4}, 10, 1.0 / 6},       {{0, 1, 2, 3, 4, 5, 6, 7}, 12, 1},
               {{0, 1, 3, 2, 4, 5, 7, 6}, 11, 1}, {{0, 3, 1, 4, 7, 5}, 13, 0.5},
               {{0, 1, 2, 3, 8}, 14, 1.0 / 3},    {{0, 1, 3, 4, 8, 8, 8, 8, 8, 8}, 24, 1.0 / 6}};
  for (const auto& test : cases) {
    Writer w({});
    const Surface s = read("cell.vtu", grid(w, corners, test.cell, {std::int64_t(test.cell.size())}, {test.type}));
    EXPECT_NEAR(volume(s), test.volume, 1e-12) << int(test.type);
  }
}

TEST_F(VtkXml, PolyhedraGiveTheirFaces) {
  Writer w({});
  const std::string faces =
      w.array<std::int64_t>("Int64", "faces", 1, {4, 3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2}) +
      w.array<std::int64_t>("Int64", "faceoffsets", 1, {17});
  const Surface s = read("poly.vtu", grid(w, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2, 3}, {4}, {42}, faces));
  EXPECT_EQ(s.triangles.size(), 4u);
  EXPECT_NEAR(volume(s), 1.0 / 6, 1e-12);
}

TEST_F(VtkXml, FlatCellsAreKept) {
  Writer w({});
  // Triangle, pixel, quadratic triangle, polygon, line, and a face of a tetrahedron given as a cell as well.
  const Surface s = read(
      "flat.vtu", grid(w, two_cubes, {0, 1, 3, 0, 1, 3, 4, 0, 1, 3, 6, 7, 8, 1, 2, 5, 4, 0, 1, 0, 3, 1, 6, 0, 1, 3},
                       {3, 7, 13, 17, 19, 23, 26}, {5, 8, 22, 7, 3, 10, 5}));
  EXPECT_EQ(s.triangles.size(), 1u + 2 + 1 + 2 + 3 + 1);
}

TEST_F(VtkXml, PiecesAndParallelFilesAreJoined) {
  Writer w({});
  const std::string single = mixed_vtp(w);
  const std::size_t begin = single.find("<Piece"), end = single.find("</PolyData>");
  std::string twice = single;
  twice.insert(end, single.substr(begin, end - begin));
  const Surface s = read("twice.vtp", twice);
  EXPECT_EQ(s.points.size(), 12u);
  ASSERT_EQ(s.triangles.size(), 8u);
  EXPECT_EQ(s.triangles[6], (Triangle{7, 10, 8}));
  EXPECT_EQ(s.find("u")->size(), 12u);

  write("part.vtp", single);
  const std::string head = "<VTKFile type=\"PPolyData\"><PPolyData>";
  EXPECT_EQ(read("all.pvtp", head + "<Piece Source=\"part.vtp\"/><Piece Source=\"part.vtp\"/></PPolyData></VTKFile>")
                .triangles.size(),
            8u);
  EXPECT_TRUE(contains(failure("lost.pvtp", head + "<Piece Source=\"lost.vtp\"/></PPolyData></VTKFile>"), "lost.vtp"));
  EXPECT_TRUE(
      contains(failure("loop.pvtp", head + "<Piece Source=\"loop.pvtp\"/></PPolyData></VTKFile>"), "PPolyData"));
}

TEST_F(VtkXml, ImagesAreVolumes) {
  Writer w({Encoding::Where::appended_raw, true});
  std::vector<std::uint8_t> values(24);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::uint8_t(i);
  std::string image = w.file("ImageData", "<Piece Extent=\"1 2 0 2 0 3\"><PointData>" +
                                              w.array("UInt8", "label", 1, values) + "</PointData></Piece>");
  image.replace(image.find("<ImageData"), 10,
                "<ImageData WholeExtent=\"1 2 0 2 0 3\" Origin=\"10 0 0\" Spacing=\"2 1 1\"");
  const fs::path path = write("image.vti", image);
  const VtkImage volume = read_vtk_image(read_all(path), path);
  EXPECT_EQ(volume.dimensions, Int3(2, 3, 4));
  EXPECT_EQ(volume.origin, Vec3d(12, 0, 0));
  EXPECT_EQ(volume.point_arrays[0].values[23], 23);
  const FileInfo info = describe(path);
  EXPECT_EQ(info.kind, "volume");
  EXPECT_EQ(info.points, 24u);
  EXPECT_EQ(info.upper, Vec3d(14, 2, 3));
  EXPECT_EQ(info.arrays[0].max, 23);
  EXPECT_TRUE(contains(failure({path}), "is a volume and has no surface"));
}

}  // namespace
}  // namespace nacre::test
