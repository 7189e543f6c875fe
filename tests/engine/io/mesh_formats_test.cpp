// Nacre: tests of the formats that solvers and slides take, by hand. tests/exchange reads them with other programs.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "compute/device/error.hpp"
#include "engine/io/cell_faces.hpp"
#include "engine/io/mesh_parts.hpp"
#include "engine/io/mesh_writer.hpp"
#include "tests/engine/io/temporary_folder.hpp"
#include "tests/engine/io/two_bodies.hpp"

namespace nacre {
namespace {

using test::body_labels;
using test::read_all;
using test::TemporaryFolder;
using test::two_bodies;
using test::two_cells;

const std::vector<std::string> names = {"outside", "liver & bile", "", "kidney, left"};

std::string written(const std::string& file, bool cells, const std::vector<std::string>& called = names) {
  const TemporaryFolder folder;
  if (cells)
    write_tetrahedral_mesh(folder / file, two_cells(), two_bodies(), body_labels, called);
  else
    write_surface_mesh(folder / file, two_bodies(), body_labels, called);
  EXPECT_EQ(folder.entries(), 1u);
  return read_all(folder / file);
}

TEST(MeshFormats, FacesOfCellsAreEachThereOnceInUpperTriangularOrder) {
  // A fan of three cells around the edge 0-1, numbered against the order in which they touch.
  const std::vector<std::array<std::uint32_t, 4>> cells = {{0, 1, 4, 5}, {0, 1, 2, 3}, {0, 1, 3, 4}};
  const std::vector<CellFace> faces = cell_faces(cells);
  ASSERT_EQ(faces.size(), 4u * 3 - 2);
  EXPECT_EQ(faces[0].owner, 0u);
  EXPECT_EQ(faces[0].neighbour, 2u);
  EXPECT_EQ(faces[1].owner, 1u);
  EXPECT_EQ(faces[1].neighbour, 2u);
  for (std::size_t i = 2; i < faces.size(); ++i) {
    EXPECT_EQ(faces[i].neighbour, no_cell);
    EXPECT_GE(faces[i].owner, faces[i - 1].owner * (i > 2));
  }
  for (const CellFace& face : faces) {
    const auto& corner = tetrahedron_faces[face.owner_face];
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(face.corners[k], cells[face.owner][std::size_t(corner[k])]);
  }
}

TEST(MeshFormats, FacesPointOutOfTheirCell) {
  const TetrahedralMesh mesh = two_cells();
  for (const CellFace& face : cell_faces(mesh.cells)) {
    Vec3d centre(0, 0, 0);
    for (const std::uint32_t corner : mesh.cells[face.owner]) centre += mesh.points[corner] * 0.25;
    const Vec3d a = mesh.points[face.corners[0]], b = mesh.points[face.corners[1]], c = mesh.points[face.corners[2]];
    EXPECT_GT(dot(cross(b - a, c - a), a - centre), 0);
  }
}

TEST(MeshFormats, WordsSuitEverySolver) {
  Identifiers words;
  EXPECT_EQ(words.of("outside - liver & bile"), "outside_liver_bile");
  EXPECT_EQ(words.of("Outside, LIVER (bile)"), "Outside_LIVER_bile_2") << "Abaqus has no case";
  EXPECT_EQ(words.of("3rd ventricle"), "group_3rd_ventricle");
  EXPECT_EQ(words.of("\u809d"), "group_");
  const std::string wide(200, 'w');
  EXPECT_EQ(words.of(wide).size(), 60u);
  EXPECT_EQ(words.of(wide), std::string(58, 'w') + "_2");
}

TEST(MeshFormats, AbaqusHasSetsPerMaterialAndSurfacesPerPair) {
  const std::string file = written("a.inp", true);
  const std::string rest = file.substr(file.find("** liver"));
  EXPECT_EQ(rest,
            "** liver & bile\n*ELEMENT, TYPE=C3D4, ELSET=liver_bile\n1, 1, 2, 3, 4\n"
            "*NSET, NSET=liver_bile\n1, 2, 3, 4\n"
            "** kidney, left\n*ELEMENT, TYPE=C3D4, ELSET=kidney_left\n2, 1, 3, 2, 5\n"
            "*NSET, NSET=kidney_left\n1, 2, 3, 5\n"
            "** outside - liver & bile\n*SURFACE, NAME=liver_bile_outside, TYPE=ELEMENT\n1, S2\n1, S3\n1, S4\n"
            "** outside - kidney, left\n*SURFACE, NAME=kidney_left_outside, TYPE=ELEMENT\n2, S2\n2, S3\n2, S4\n"
            "** liver & bile - kidney, left\n*SURFACE, NAME=liver_bile_kidney_left, TYPE=ELEMENT\n1, S1\n"
            "*SURFACE, NAME=kidney_left_liver_bile, TYPE=ELEMENT\n2, S1\n");
  EXPECT_NE(file.find("*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n"), file.npos);
}

TEST(MeshFormats, AbaqusSurfacesAreShellsWithTwoSides) {
  const std::string file = written("a.inp", false, {});
  EXPECT_NE(file.find("*ELEMENT, TYPE=S3, ELSET=material_0_5\n1, 2, 3, 4\n2, 1, 4, 3\n3, 1, 2, 4\n"
                      "*NSET, NSET=material_0_5\n1, 2, 3, 4\n"),
            file.npos);
  EXPECT_NE(file.find("*SURFACE, NAME=material_5_300_SPOS, TYPE=ELEMENT\nmaterial_5_300, SPOS\n"
                      "*SURFACE, NAME=material_5_300_SNEG, TYPE=ELEMENT\nmaterial_5_300, SNEG\n"),
            file.npos);
}

TEST(MeshFormats, AbaqusHasAtMostSixteenNumbersInALine) {
  SurfaceMesh mesh;
  for (int i = 0; i < 33; ++i) mesh.points.push_back({double(i), double(i % 2), double(i * i)});
  for (std::uint32_t i = 0; i + 2 < 33; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  mesh.materials.assign(mesh.triangles.size(), {0, 1});
  const TemporaryFolder folder;
  write_surface_mesh(folder / "a.inp", mesh, body_labels);
  const std::string file = read_all(folder / "a.inp");
  const std::size_t set = file.find("*NSET"), begin = file.find('\n', set) + 1;
  EXPECT_EQ(file.substr(begin, file.find('*', begin) - begin),
            "1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16\n"
            "17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32\n33\n");
}

TEST(MeshFormats, Gmsh4HasAnEntityPerGroup) {
  const std::string file = written("a.msh4", true);
  EXPECT_TRUE(file.starts_with(std::string("$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n", 40)));
  EXPECT_NE(file.find("$PhysicalNames\n5\n2 1 \"outside - liver & bile\"\n"), file.npos);
  EXPECT_NE(file.find("\n3 5 \"liver & bile\"\n3 300 \"kidney, left\"\n$EndPhysicalNames\n"), file.npos);
  std::size_t at = file.find("$Entities\n") + 10 + 32;
  const auto take = [&]<class T>(T) {
    T value;
    std::memcpy(&value, &file[at], sizeof value);
    at += sizeof value;
    return value;
  };
  std::vector<std::int32_t> bounds;
  for (int entity = 0; entity < 5; ++entity) {
    EXPECT_EQ(take(std::int32_t()), (std::array{1, 2, 3, 5, 300}[std::size_t(entity)]));
    at += 48;
    EXPECT_EQ(take(std::uint64_t()), 1u);
    at += 4;
    for (std::uint64_t left = take(std::uint64_t()); left > 0; --left) bounds.push_back(take(std::int32_t()));
  }
  EXPECT_EQ(bounds, (std::vector<std::int32_t>{1, -3, 2, 3})) << "the interface of both points out of the second";
  EXPECT_EQ(file.substr(at, 14), "\n$EndEntities\n");
  at = file.find("$Elements\n") + 10 + 32;
  for (const auto& [tag, elements] :
       std::map<std::int32_t, std::vector<std::vector<std::uint64_t>>>{{1, {{2, 3, 4}, {1, 4, 3}, {1, 2, 4}}},
                                                                       {2, {{2, 5, 3}, {1, 3, 5}, {1, 5, 2}}},
                                                                       {3, {{1, 2, 3}}},
                                                                       {5, {{1, 2, 3, 4}}},
                                                                       {300, {{1, 3, 2, 5}}}}) {
    at += 4;  // the dimension
    EXPECT_EQ(take(std::int32_t()), tag);
    at += 4;  // the type
    ASSERT_EQ(take(std::uint64_t()), elements.size());
    for (const std::vector<std::uint64_t>& nodes : elements) {
      at += 8;  // the number of the element
      for (const std::uint64_t node : nodes) EXPECT_EQ(take(std::uint64_t()), node) << tag;
    }
  }
  EXPECT_EQ(file.substr(at, 14), "\n$EndElements\n");
}

TEST(MeshFormats, MfemHasAttributesWithNames) {
  const std::string file = written("a.mesh", true);
  EXPECT_TRUE(file.starts_with("MFEM mesh v1.3\n\ndimension\n3\n\nelements\n2\n5 4 0 1 2 3\n300 4 0 2 1 4\n"));
  EXPECT_NE(
      file.find("attribute_sets\n2\n\"liver & bile\"\n1\n5\n\"kidney, left\"\n1\n300\n\nboundary\n7\n1 2 1 2 3\n"),
      file.npos);
  EXPECT_NE(file.find("\nvertices\n5\n3\n0 0 0\n"), file.npos);
}

TEST(MeshFormats, FebioHasPartsSurfacesAndPairs) {
  const std::string file = written("a.feb", true);
  EXPECT_NE(file.find("<Elements type=\"tet4\" name=\"liver &amp; bile\">\n<elem id=\"1\">1,2,3,4</elem>\n"),
            file.npos);
  EXPECT_NE(file.find("<NodeSet name=\"kidney, left\">1,2,3,5</NodeSet>"), file.npos);
  EXPECT_NE(file.find("<Surface name=\"liver &amp; bile - kidney, left\">\n<tri3 id=\"1\">1,3,2</tri3>\n"), file.npos);
  EXPECT_NE(file.find("<Surface name=\"kidney, left - liver &amp; bile\">\n<tri3 id=\"1\">1,2,3</tri3>\n"), file.npos);
  EXPECT_NE(file.find("<primary>liver &amp; bile - kidney, left</primary>"), file.npos);
}

std::string written_at_second_order(const std::string& file, bool cells) {
  const TemporaryFolder folder;
  const SecondOrder second = test::two_bodies_nodes(cells);
  if (cells)
    write_tetrahedral_mesh(folder / file, two_cells(), two_bodies(), body_labels, names, "", &second);
  else
    write_surface_mesh(folder / file, two_bodies(), body_labels, names, "", &second);
  EXPECT_EQ(folder.entries(), 1u);
  return read_all(folder / file);
}

TEST(MeshFormats, AbaqusHasNodesOnEdges) {
  const std::string cells = written_at_second_order("a.inp", true);
  EXPECT_NE(cells.find("\n6, 0.5, 0, 0\n7, 0, 0.5, 0\n"), cells.npos);
  EXPECT_NE(cells.find("*ELEMENT, TYPE=C3D10, ELSET=liver_bile\n1, 1, 2, 3, 4, 6, 10, 7, 8, 11, 13\n"
                       "*NSET, NSET=liver_bile\n1, 2, 3, 4, 6, 7, 8, 10, 11, 13\n"),
            cells.npos);
  EXPECT_NE(cells.find("TYPE=C3D10, ELSET=kidney_left\n2, 1, 3, 2, 5, 7, 10, 6, 9, 14, 12\n"), cells.npos);
  const std::string triangles = written_at_second_order("a.inp", false);
  EXPECT_NE(triangles.find("TYPE=STRI65, ELSET=liver_bile_kidney_left\n7, 1, 2, 3, 6, 10, 7\n"), triangles.npos)
      << triangles;
}

TEST(MeshFormats, FebioHasNodesOnEdges) {
  const std::string file = written_at_second_order("a.feb", true);
  EXPECT_NE(file.find("<Elements type=\"tet10\" name=\"liver &amp; bile\">\n"
                      "<elem id=\"1\">1,2,3,4,6,10,7,8,11,13</elem>\n"),
            file.npos);
  EXPECT_NE(file.find("liver &amp; bile - kidney, left\">\n<tri6 id=\"1\">1,3,2,7,10,6</tri6>\n"), file.npos);
  EXPECT_NE(file.find("kidney, left - liver &amp; bile\">\n<tri6 id=\"1\">1,2,3,6,10,7</tri6>\n"), file.npos);
  EXPECT_NE(file.find("<node id=\"14\">0,0.5,-0.5</node>"), file.npos);
  EXPECT_NE(file.find("<NodeSet name=\"kidney, left\">1,2,3,5,6,7,9,10,12,14</NodeSet>"), file.npos);
}

TEST(MeshFormats, MfemHasAGridFunctionOfPositions) {
  const std::string file = written_at_second_order("a.mesh", true);
  EXPECT_NE(file.find("\nvertices\n5\n\nnodes\nFiniteElementSpace\nFiniteElementCollection: H1_3D_P2\nVDim: 3\n"
                      "Ordering: 1\n\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 -1\n"
                      "0.5 0 0\n0 0.5 0\n0 0 0.5\n0.5 0.5 0\n0.5 0 0.5\n0 0.5 0.5\n"
                      "0 0 -0.5\n0 0.5 -0.5\n0.5 0 -0.5\n\nmfem_mesh_end\n"),
            file.npos)
      << file;
}

TEST(MeshFormats, GmshHasTheLastTwoNodesTheOtherWayRound) {
  const std::array<std::int32_t, 10> wanted = {1, 2, 3, 4, 6, 10, 7, 8, 13, 11};
  const std::string bytes(reinterpret_cast<const char*>(wanted.data()), sizeof wanted);
  EXPECT_NE(written_at_second_order("a.msh", true).find(bytes), std::string::npos);
  const std::array<std::uint64_t, 10> wide = {1, 2, 3, 4, 6, 10, 7, 8, 13, 11};
  const std::string wide_bytes(reinterpret_cast<const char*>(wide.data()), sizeof wide);
  EXPECT_NE(written_at_second_order("a.msh4", true).find(wide_bytes), std::string::npos);
  const std::array<std::int32_t, 6> triangle = {1, 2, 3, 6, 10, 7};
  EXPECT_NE(written_at_second_order("a.msh", false)
                .find(std::string(reinterpret_cast<const char*>(triangle.data()), sizeof triangle)),
            std::string::npos);
}

TEST(MeshFormats, MaterialsApartHaveTheirNodes) {
  const TemporaryFolder folder;
  const SecondOrder second = test::two_bodies_nodes(false);
  const auto files = write_material_surfaces(folder / "a.inp", two_bodies(), body_labels, names, "", &second);
  ASSERT_EQ(files.size(), 2u);
  // The second body from its first triangle, {0, 1, 2} with the body inside: points and nodes as they come.
  const std::string file = read_all(files[1]);
  EXPECT_NE(file.find("TYPE=STRI65, ELSET=kidney_left\n1, 1, 2, 3, 5, 6, 7\n"), file.npos) << file;
  EXPECT_NE(file.find("\n4, 0, 0, -1\n5, 0.5, 0, 0\n6, 0.5, 0.5, 0\n7, 0, 0.5, 0\n"), file.npos) << file;
}

TEST(MeshFormats, FormatsWithoutNodesOnEdgesSaySo) {
  const TemporaryFolder folder;
  const SecondOrder second = test::two_bodies_nodes(true);
  for (const char* file : {"a.foam"}) {
    try {
      write_tetrahedral_mesh(folder / file, two_cells(), two_bodies(), body_labels, names, "", &second);
      ADD_FAILURE() << file;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(".vtu"), std::string::npos) << error.what();
    }
  }
  for (const char* file : {"a.stl", "a.vtp", "a.glb", "a.obj", "a.ply", "a.off"})
    EXPECT_THROW(write_surface_mesh(folder / file, two_bodies(), body_labels, names, "", &second), Error) << file;
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(MeshFormats, OpenFoamHasPatchesAndZones) {
  const TemporaryFolder folder;
  write_tetrahedral_mesh(folder / "a.foam", two_cells(), two_bodies(), body_labels, names);
  const auto body = [&](const std::string& file) {
    const std::string text = read_all(folder / ("constant/polyMesh/" + file));
    return text.substr(text.find("}\n\n") + 3);
  };
  EXPECT_EQ(body("owner"), "7\n(\n0\n0\n0\n0\n1\n1\n1\n)\n");
  EXPECT_EQ(body("neighbour"), "1\n(\n1\n)\n");
  EXPECT_TRUE(body("faces").starts_with("7\n(\n3(0 2 1)\n"));
  EXPECT_EQ(body("boundary"),
            "2\n(\noutside_liver_bile\n{\n    type        patch;\n    nFaces      3;\n    startFace   1;\n}\n"
            "outside_kidney_left\n{\n    type        patch;\n    nFaces      3;\n    startFace   4;\n}\n)\n");
  EXPECT_EQ(body("faceZones"),
            "1\n(\nliver_bile_kidney_left\n{\n    type        faceZone;\n    faceLabels  List<label>\n1\n(\n0\n);\n"
            "    flipMap     List<bool>\n1\n(\n1\n);\n}\n)\n");
  EXPECT_NE(
      body("cellZones").find("kidney_left\n{\n    type        cellZone;\n    cellLabels  List<label>\n1\n(\n1\n);"),
      std::string::npos);
  EXPECT_TRUE(read_all(folder / "a.foam").empty());
  std::ofstream(folder / "system/controlDict") << "mine";
  write_tetrahedral_mesh(folder / "a.foam", two_cells(), two_bodies(), body_labels, names);
  EXPECT_EQ(read_all(folder / "system/controlDict"), "mine");
}

TEST(MeshFormats, OpenFoamLeavesNothingBehindAfterAFailure) {
  const TemporaryFolder folder;
  std::ofstream(folder / "constant") << "a file";
  EXPECT_THROW(write_tetrahedral_mesh(folder / "a.foam", two_cells(), two_bodies(), body_labels, names), Error);
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(MeshFormats, GltfHasAMeshPerPair) {
  const std::string file = written("a.glb", false);
  std::uint32_t head[5];
  std::memcpy(head, file.data(), sizeof head);
  EXPECT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(head[1], 2u);
  EXPECT_EQ(head[2], file.size());
  const auto asset = nlohmann::json::parse(file.substr(20, head[3]));
  ASSERT_EQ(asset["meshes"].size(), 3u);
  EXPECT_EQ(asset["nodes"][3]["name"], "liver & bile - kidney, left");
  std::set<std::string> colours;
  for (const auto& material : asset["materials"]) {
    const auto& rgb = material["pbrMetallicRoughness"]["baseColorFactor"];
    EXPECT_NEAR(rgb[0].get<double>() + rgb[1].get<double>() + rgb[2].get<double>(), 1.35, 1e-9) << "alike in lightness";
    colours.insert(rgb.dump());
  }
  EXPECT_EQ(colours.size(), 3u);
  const auto& accessor = asset["accessors"][asset["meshes"][2]["primitives"][0]["attributes"]["POSITION"].get<int>()];
  EXPECT_EQ(accessor["count"], 3);
  EXPECT_EQ(accessor["max"], (nlohmann::json{0.5, 0.5, 0})) << "about the centre of the box";
  EXPECT_EQ(asset["nodes"][0]["children"], (nlohmann::json{1, 2, 3}));
  EXPECT_EQ(asset["buffers"][0]["byteLength"].get<std::size_t>() + 28 + head[3], file.size());
}

TEST(MeshFormats, MaterialsApartHaveTheirNames) {
  const TemporaryFolder folder;
  for (const char* extension : {".inp", ".msh4", ".glb"}) {
    const auto files =
        write_material_surfaces(folder / (std::string("a") + extension), two_bodies(), body_labels, names);
    ASSERT_EQ(files.size(), 2u);
    const std::string file = read_all(files[1]);
    EXPECT_NE(file.find("kidney, left"), file.npos) << extension;
    EXPECT_EQ(file.find("outside"), file.npos) << extension;
  }
}

}  // namespace
}  // namespace nacre
