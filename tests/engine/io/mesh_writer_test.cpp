// Nacre: tests of the writers of meshes of materials, read back by our own readers or by hand.
#include "engine/io/mesh_writer.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <set>

#include "compute/device/error.hpp"
#include "engine/io/reader.hpp"
#include "engine/io/registry.hpp"
#include "engine/io/vtk_xml.hpp"
#include "tests/engine/io/temporary_folder.hpp"
#include "tests/engine/io/two_bodies.hpp"

namespace nacre {
namespace {

using test::read_all;
using test::TemporaryFolder;
using test::two_bodies;
using test::two_cells;

const std::vector<std::int64_t> labels = test::body_labels;

double volume(const Surface& s) {
  double sum = 0;
  for (const Triangle& t : s.triangles) sum += dot(s.points[t.a], cross(s.points[t.b], s.points[t.c])) / 6;
  return sum;
}

const RawArray* find(const std::vector<RawArray>& arrays, const std::string& name) {
  for (const RawArray& a : arrays)
    if (a.name == name) return &a;
  return nullptr;
}

TEST(MeshWriter, FacesKeepTheirMaterials) {
  const TemporaryFolder folder;
  const SurfaceMesh mesh = two_bodies();
  write_surface_mesh(folder / "a.vtp", mesh, labels);
  write_surface_mesh(folder / "a.ply", mesh, labels);
  const RawMesh raw = read_raw(folder / "a.vtp").mesh;
  ASSERT_EQ(raw.polygons(), mesh.triangles.size());
  EXPECT_TRUE(raw.points == mesh.points);
  EXPECT_EQ(raw.lines, 0u);
  const RawArray *low = find(raw.cell_arrays, "material_0"), *high = find(raw.cell_arrays, "material_1");
  ASSERT_TRUE(low && high);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    EXPECT_EQ(low->values[i], float(labels[mesh.materials[i][0]]));
    EXPECT_EQ(high->values[i], float(labels[mesh.materials[i][1]]));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(raw.polygon(i)[std::size_t(k)], mesh.triangles[i][k]);
  }
  EXPECT_NE(read_all(folder / "a.vtp").find("type=\"Int32\" Name=\"material_0\""), std::string::npos);

  const std::string ply = read_all(folder / "a.ply");
  EXPECT_EQ(read_raw(folder / "a.ply").mesh.polygons(), mesh.triangles.size());
  const std::size_t body = ply.find("end_header\n") + 11;
  ASSERT_EQ(ply.size(), body + 5 * 24 + 7 * (13 + 8));
  std::int32_t sides[2];
  std::memcpy(sides, &ply[body + 5 * 24 + 21 + 13], 8);  // of the second triangle
  EXPECT_EQ(sides[0], 5);
  EXPECT_EQ(sides[1], 300);
}

TEST(MeshWriter, WideLabelsStayWhole) {
  const TemporaryFolder folder;
  std::vector<std::int64_t> wide = labels;
  wide[3] = 1ll << 40;
  write_surface_mesh(folder / "a.vtp", two_bodies(), wide);
  EXPECT_NE(read_all(folder / "a.vtp").find("type=\"Int64\" Name=\"material_1\""), std::string::npos);
  EXPECT_THROW(write_surface_mesh(folder / "a.ply", two_bodies(), wide), Error);
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(MeshWriter, ObjHasAGroupPerPair) {
  const TemporaryFolder folder;
  write_surface_mesh(folder / "a.obj", two_bodies(), labels);
  const std::string file = read_all(folder / "a.obj");
  EXPECT_EQ(file.substr(file.find("g ")),
            "g material_0_5\nf 2 3 4\nf 1 4 3\nf 1 2 4\ng material_0_300\nf 2 5 3\nf 1 3 5\nf 1 5 2\n"
            "g material_5_300\nf 1 2 3\n");
}

TEST(MeshWriter, EveryFormatReadsBackWithAllTriangles) {
  const TemporaryFolder folder;
  for (const std::string extension : {".vtp", ".ply", ".obj", ".off", ".stl"}) {
    write_surface_mesh(folder / ("a" + extension), two_bodies(), labels);
    EXPECT_EQ(read_raw(folder / ("a" + extension)).mesh.polygons(), 7u) << extension;
  }
}

TEST(MeshWriter, MaterialsApartAreClosedAndTurnedOutwards) {
  const TemporaryFolder folder;
  for (const std::string extension : {".vtp", ".ply", ".obj", ".off", ".stl"}) {
    const auto files = write_material_surfaces(folder / ("a" + extension), two_bodies(), labels);
    ASSERT_EQ(files.size(), 2u);  // material 2 has no surface
    EXPECT_EQ(files[0], folder / ("a_5" + extension));
    EXPECT_EQ(files[1], folder / ("a_300" + extension));
    for (const auto& file : files) {
      const Surface s = open_surface({file}).load(0);
      EXPECT_EQ(s.triangles.size(), 4u) << file;
      EXPECT_EQ(s.points.size(), 4u) << file;
      EXPECT_NEAR(volume(s), 1. / 6, 1e-6) << file;
    }
  }
}

/// A .msh of version 2.2, binary, taken apart.
struct Msh {
  std::vector<Vec3d> points;
  std::vector<std::vector<std::uint32_t>> cells;  ///< from 0
  std::vector<std::int32_t> group;
  std::map<std::pair<int, std::int32_t>, std::string> names;  ///< by dimension and tag
  std::map<std::string, std::vector<double>> numbers;

  explicit Msh(const std::string& file) : file_(file) {
    EXPECT_TRUE(file.starts_with(std::string("$MeshFormat\n2.2 1 8\n\1\0\0\0\n$EndMeshFormat\n", 40)));
    seek("$PhysicalNames\n");
    for (int left = std::stoi(line()); left > 0; --left) {
      const std::string text = line();
      const std::size_t tag = text.find(' ') + 1, name = text.find('"');
      names[{std::stoi(text), std::stoi(text.substr(tag))}] = text.substr(name + 1, text.size() - name - 2);
    }
    seek("$Nodes\n");
    points.resize(std::stoul(line()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(take<std::int32_t>(), std::int32_t(i + 1));
      points[i] = take<Vec3d>();
    }
    EXPECT_EQ(file_.compare(at_, 11, "\n$EndNodes\n"), 0);
    seek("$Elements\n");
    cells.resize(std::stoul(line()));
    for (std::size_t i = 0; i < cells.size();) {
      const int type = take<std::int32_t>(), count = take<std::int32_t>();
      EXPECT_EQ(take<std::int32_t>(), 2);
      for (const std::size_t end = std::min(i + std::size_t(std::max(count, 1)), cells.size()); i < end; ++i) {
        EXPECT_EQ(take<std::int32_t>(), std::int32_t(i + 1));
        group.push_back(take<std::int32_t>());
        EXPECT_EQ(take<std::int32_t>(), group.back());
        for (int k = 0; k < (type == 2 ? 3 : 4); ++k) cells[i].push_back(take<std::uint32_t>() - 1);
      }
    }
    EXPECT_EQ(file_.compare(at_, 14, "\n$EndElements\n"), 0);
    while (file_.find("$ElementData\n", at_) != std::string::npos) {
      seek("$ElementData\n");
      std::string text;
      for (int i = 0; i < 7; ++i) {
        const std::string next = line();
        if (i == 1) text = next.substr(1, next.size() - 2);
      }
      std::vector<double>& values = numbers[text];
      values.resize(std::stoul(line()));
      for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(take<std::int32_t>(), std::int32_t(i + 1));
        values[i] = take<double>();
      }
      EXPECT_EQ(file_.compare(at_, 17, "\n$EndElementData\n"), 0);
    }
  }

 private:
  void seek(const std::string& what) { at_ = file_.find(what, at_) + what.size(); }
  std::string line() {
    const std::size_t begin = at_;
    at_ = file_.find('\n', at_) + 1;
    return file_.substr(begin, at_ - 1 - begin);
  }
  template <class T>
  T take() {
    T value;
    std::memcpy(&value, file_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

  const std::string file_;
  std::size_t at_ = 0;
};

TEST(MeshWriter, GmshSurfaceHasAGroupPerPair) {
  const TemporaryFolder folder;
  const SurfaceMesh mesh = two_bodies();
  write_surface_mesh(folder / "a.msh", mesh, labels);
  const Msh msh(read_all(folder / "a.msh"));
  EXPECT_TRUE(msh.points == mesh.points);
  ASSERT_EQ(msh.cells.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(msh.cells[i][std::size_t(k)], mesh.triangles[i][k]);
    EXPECT_EQ(msh.numbers.at("material_0")[i], double(labels[mesh.materials[i][0]]));
    EXPECT_EQ(msh.numbers.at("material_1")[i], double(labels[mesh.materials[i][1]]));
  }
  EXPECT_EQ(msh.names.size(), 3u);
  EXPECT_EQ(msh.names.at({2, msh.group[1]}), "material_5_300");
  EXPECT_EQ(msh.names.at({2, msh.group[4]}), "material_0_300");
  EXPECT_EQ(write_material_surfaces(folder / "b.msh", mesh, labels).size(), 2u);
  EXPECT_EQ(Msh(read_all(folder / "b_300.msh")).cells.size(), 4u);
}

TEST(MeshWriter, GmshGroupsHaveTheNamesOfTheirMaterials) {
  const TemporaryFolder folder;
  const std::vector<std::string> names = {"outside", "Le foie, d\u00e9coup\u00e9", "", "skin \"thin\""};
  write_tetrahedral_mesh(folder / "a.msh", two_cells(), two_bodies(), labels, names);
  const Msh msh(read_all(folder / "a.msh"));
  EXPECT_EQ(msh.names.at({2, msh.group[0]}), "outside - Le foie, d\u00e9coup\u00e9");
  EXPECT_EQ(msh.names.at({2, msh.group[1]}), "Le foie, d\u00e9coup\u00e9 - skin _thin_");
  EXPECT_EQ(msh.names.at({3, 5}), "Le foie, d\u00e9coup\u00e9");
  EXPECT_EQ(msh.names.at({3, 300}), "skin _thin_");
  write_surface_mesh(folder / "b.msh", two_bodies(), labels, std::vector<std::string>{"outside", "", "", "skin"});
  const Msh some(read_all(folder / "b.msh"));
  EXPECT_EQ(some.names.at({2, some.group[0]}), "outside - material_5") << "one without a name keeps its label";
  EXPECT_EQ(some.names.at({2, some.group[1]}), "material_5 - skin");
  write_material_surfaces(folder / "c.msh", two_bodies(), labels, names);
  EXPECT_EQ(Msh(read_all(folder / "c_300.msh")).names.at({2, 1}), "skin _thin_");
}

TEST(MeshWriter, GmshGroupsAreToldApartByTheirNames) {
  const TemporaryFolder folder;
  const std::string wide(126, 'w');
  for (const auto& names : {std::vector<std::string>{"outside", "cyst", "cyst", "cyst"},
                            std::vector<std::string>{"outside", wide + "\u00e9", "", wide + "\u00e9"}}) {
    write_tetrahedral_mesh(folder / "a.msh", two_cells(), two_bodies(), labels, names);
    const Msh msh(read_all(folder / "a.msh"));
    std::set<std::string> different;
    for (const auto& [group, name] : msh.names) {
      different.insert(name);
      EXPECT_LE(name.size(), 127u + 2);
      EXPECT_NE(name.back(), '\xc3') << "half a letter";
    }
    EXPECT_EQ(different.size(), 5u);
  }
}

TEST(MeshWriter, VtkFilesHaveTheNamesAsFieldData) {
  const TemporaryFolder folder;
  const std::vector<std::string> names = {"outside", "liver & bile", "", "skin"};
  write_surface_mesh(folder / "a.vtp", two_bodies(), labels, names);
  write_tetrahedral_mesh(folder / "a.vtu", two_cells(), two_bodies(), labels, names);
  for (const char* file : {"a.vtp", "a.vtu"}) {
    const std::vector<RawArray> field = VtkXmlFile(read_all(folder / file), folder / file).field_arrays();
    ASSERT_EQ(field.size(), 4u);
    const std::vector<std::pair<std::string, float>> expected = {
        {"outside", 0}, {"liver & bile", 5}, {"material_-7", -7}, {"skin", 300}};
    for (std::size_t m = 0; m < 4; ++m) {
      EXPECT_EQ(field[m].name, expected[m].first);
      EXPECT_EQ(field[m].values, std::vector<float>{expected[m].second});
    }
    EXPECT_EQ(read_raw(folder / file).mesh.points.size(), 5u);
  }
  write_surface_mesh(folder / "b.vtp", two_bodies(), labels);
  EXPECT_EQ(read_all(folder / "b.vtp").find("FieldData"), std::string::npos);
  write_surface_mesh(folder / "c.vtp", two_bodies(), labels, std::vector<std::string>{"", "caf\xe9", "", ""});
  EXPECT_NE(read_all(folder / "c.vtp").find("Name=\"caf\ufffd\""), std::string::npos) << "Latin-1 would be no XML";
}

/// ParaView 5.11 with today's expat finds no appended data.
TEST(MeshWriter, VtkFilesHaveTheirNumbersBetweenTheTags) {
  const TemporaryFolder folder;
  write_surface_mesh(folder / "a.vtp", two_bodies(), labels);
  write_tetrahedral_mesh(folder / "a.vtu", two_cells(), two_bodies(), labels);
  for (const char* file : {"a.vtp", "a.vtu"}) {
    const std::string text = read_all(folder / file);
    EXPECT_EQ(text.find("AppendedData"), std::string::npos);
    EXPECT_EQ(text.find('\1'), std::string::npos);
    EXPECT_NE(text.find("Name=\"Points\" NumberOfComponents=\"3\" format=\"binary\">eAAAAAAAAA"), std::string::npos)
        << "120 bytes of five points";
  }
}

TEST(MeshWriter, TetrahedraKeepTheirMaterials) {
  const TemporaryFolder folder;
  const TetrahedralMesh mesh = two_cells();
  write_tetrahedral_mesh(folder / "a.vtu", mesh, two_bodies(), labels);
  const RawMesh raw = read_raw(folder / "a.vtu").mesh;
  EXPECT_EQ(raw.volume_cells, 2u);
  EXPECT_EQ(raw.polygons(), 6u);  // the outer faces
  const RawArray* material = find(raw.cell_arrays, "material");
  ASSERT_TRUE(material);
  EXPECT_EQ(std::set<float>(material->values.begin(), material->values.end()), (std::set<float>{5, 300}));
}

TEST(MeshWriter, GmshTetrahedraComeWithTheTrianglesBetweenMaterials) {
  const TemporaryFolder folder;
  const TetrahedralMesh mesh = two_cells();
  const SurfaceMesh surface = two_bodies();
  write_tetrahedral_mesh(folder / "a.msh", mesh, surface, labels);
  const Msh msh(read_all(folder / "a.msh"));
  ASSERT_EQ(msh.cells.size(), 7u + 2u);
  for (std::size_t i = 0; i < 7; ++i) {
    ASSERT_EQ(msh.cells[i].size(), 3u);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(msh.cells[i][std::size_t(k)], surface.triangles[i][k]);
  }
  EXPECT_TRUE(msh.numbers.empty()) << "meshio 5.3 does not read a file that has some beside cells of two kinds";
  EXPECT_EQ(msh.names.size(), 3u + 2u);
  EXPECT_EQ(msh.names.at({2, msh.group[1]}), "material_5_300");
  EXPECT_EQ(msh.cells[8], (std::vector<std::uint32_t>{0, 2, 1, 4}));
  for (std::size_t i = 7; i < 9; ++i) {
    const std::int32_t label = i == 7 ? 5 : 300;
    EXPECT_EQ(msh.group[i], label) << "the labels themselves";
    const auto& c = msh.cells[i];
    const Vec3d a = msh.points[c[0]];
    EXPECT_NEAR(dot(msh.points[c[1]] - a, cross(msh.points[c[2]] - a, msh.points[c[3]] - a)), 1, 1e-15);
  }
  EXPECT_EQ(msh.names.at({3, 300}), "material_300");
  const std::vector<std::int64_t> negative = {0, -1, 2, 3};
  write_tetrahedral_mesh(folder / "b.msh", mesh, surface, negative);
  const std::vector<std::int32_t> group = Msh(read_all(folder / "b.msh")).group;
  EXPECT_EQ(group[7], 1);  // numbers instead
  EXPECT_EQ(group[8], 3);
}

TEST(MeshWriter, BadMeshesAndExtensionsAreErrors) {
  const TemporaryFolder folder;
  for (const std::string& extension : surface_mesh_extensions()) {
    SurfaceMesh mesh = two_bodies();
    mesh.triangles[3].b = 5;
    EXPECT_THROW(write_surface_mesh(folder / ("a" + extension), mesh, labels), Error);
    EXPECT_THROW(write_material_surfaces(folder / ("a" + extension), mesh, labels), Error);
    mesh = two_bodies();
    mesh.materials[3] = {0, 4};
    EXPECT_THROW(write_surface_mesh(folder / ("a" + extension), mesh, labels), Error);
    EXPECT_THROW(write_surface_mesh(folder / ("a" + extension), {}, labels), Error);
  }
  for (const std::string& extension : tetrahedral_mesh_extensions()) {
    TetrahedralMesh mesh = two_cells();
    mesh.cells[0][2] = 5;
    EXPECT_THROW(write_tetrahedral_mesh(folder / ("a" + extension), mesh, two_bodies(), labels), Error);
    mesh = two_cells();
    mesh.material[0] = 4;
    EXPECT_THROW(write_tetrahedral_mesh(folder / ("a" + extension), mesh, two_bodies(), labels), Error);
    EXPECT_THROW(write_tetrahedral_mesh(folder / ("a" + extension), {}, two_bodies(), labels), Error);
    EXPECT_THROW(write_tetrahedral_mesh(folder / ("a" + extension), two_cells(), {}, labels), Error);
    SurfaceMesh larger = two_bodies();
    larger.points.resize(6);
    EXPECT_THROW(write_tetrahedral_mesh(folder / ("a" + extension), two_cells(), larger, labels), Error);
  }
  EXPECT_THROW(write_surface_mesh(folder / "a.vtu", two_bodies(), labels), Error);
  EXPECT_THROW(write_tetrahedral_mesh(folder / "a.vtp", two_cells(), two_bodies(), labels), Error);
  EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace nacre
