// Nacre: tests of the formats that VTK reads in a child process. Those that need VTK skip where it was not built.
#include "engine/io/vtk_child.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "compute/device/error.hpp"
#include "engine/io/reader.hpp"
#include "tests/engine/io/temporary_folder.hpp"
#include "tests/paths.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;
using test::read_all;
using test::TemporaryFolder;

#define NEEDS_VTK() \
  if (!vtk_child_available()) GTEST_SKIP() << "nacre-vtk-import was not built (VTK not found)"

/// Puts a shell script in the child's position.
class FakeChild {
 public:
  FakeChild(const TemporaryFolder& folder, const std::string& script) {
    if (const char* value = std::getenv(variable)) before_ = value;
    const fs::path path = folder / "child.sh";
    std::ofstream(path) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(path, fs::perms::owner_all);
    ::setenv(variable, path.c_str(), 1);
  }
  ~FakeChild() {
    if (before_)
      ::setenv(variable, before_->c_str(), 1);
    else
      ::unsetenv(variable);
  }

 private:
  static constexpr const char* variable = "NACRE_VTK_IMPORT";
  std::optional<std::string> before_;
};

std::string error_of(const fs::path& file, const std::string& parts = {}) {
  try {
    convert_with_vtk(file, parts);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

long number_after(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key);
  return at == std::string::npos ? -1 : std::atol(text.c_str() + at + key.size());
}

long triangles_in(const fs::path& vtp) { return number_after(read_all(vtp), "NumberOfPolys=\""); }

fs::path write(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  fs::create_directories((folder / name).parent_path());
  std::ofstream(folder / name) << text;
  return folder / name;
}

constexpr const char* cube_file = R"(# vtk DataFile Version 3.0
cube
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 8 float
0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1
CELLS 1 9
8 0 1 2 3 4 5 6 7
CELL_TYPES 1
12
CELL_DATA 1
SCALARS pressure float 1
LOOKUP_TABLE default
7
VECTORS velocity float
1 2 3
)";

TEST(VtkChild, KnowsItsFormats) {
  EXPECT_TRUE(vtk_child_reads(".vtk"));
  EXPECT_TRUE(vtk_child_reads(".foam"));
  EXPECT_FALSE(vtk_child_reads(".vtp"));
  EXPECT_FALSE(vtk_child_reads(""));
}

TEST(VtkChild, AbsenceIsAnError) {
  const TemporaryFolder folder;
  const FakeChild fake(folder, "");
  fs::remove(folder / "child.sh");
  EXPECT_FALSE(vtk_child_available());
  EXPECT_NE(error_of("a.vtk").find("built without VTK"), std::string::npos);
}

TEST(VtkChild, StepsAreTakenFromItsOutput) {
  const TemporaryFolder folder;
  const FakeChild fake(folder, "touch \"$2/a b.vtp\"; echo \"0.25 $2/a b.vtp\"; echo nonsense");
  fs::path scratch;
  {
    const VtkConversion conversion = convert_with_vtk("a.vtk");
    const VtkConversion copy = conversion;
    scratch = *conversion.folder;
    EXPECT_EQ(copy.times, std::vector<double>{0.25});
    ASSERT_EQ(copy.files.size(), 1u);
    EXPECT_EQ(copy.files[0], scratch / "a b.vtp");
    EXPECT_TRUE(fs::exists(copy.files[0]));
  }
  EXPECT_FALSE(fs::exists(scratch));
}

TEST(VtkChild, CrashComplaintSilenceAndInterrupt) {
  const TemporaryFolder folder;
  {
    const FakeChild fake(folder, "echo noise >&2; kill -SEGV $$");
    EXPECT_NE(error_of("a.vtk").find("a.vtk (VTK crashed on it (signal 11))"), std::string::npos);
  }
  {
    const FakeChild fake(folder, "echo noise >&2; echo 'nacre-vtk-import: Unrecognized file type' >&2; exit 1");
    EXPECT_NE(error_of("a.vtk").find("a.vtk (Unrecognized file type)"), std::string::npos);
  }
  {
    const FakeChild fake(folder, "exit 0");
    EXPECT_NE(error_of("a.vtk").find("no surface"), std::string::npos);
  }
  const FakeChild fake(folder, "kill -INT $$");
  EXPECT_THROW(convert_with_vtk("a.vtk"), Interrupted);
}

TEST(VtkChild, StopFlagInterrupts) {
  const TemporaryFolder folder;
  const FakeChild fake(folder, "exec sleep 60");
  const std::atomic<bool> stop{true};
  watch_import_children(&stop);
  EXPECT_THROW(convert_with_vtk("a.vtk"), Interrupted);
  watch_import_children(nullptr);
}

TEST(VtkChild, HexahedronBecomesTwelveTrianglesWithPointArrays) {
  NEEDS_VTK();
  const TemporaryFolder folder;
  const VtkConversion conversion = convert_with_vtk(write(folder, "a cube.vtk", cube_file));
  ASSERT_EQ(conversion.files.size(), 1u);
  EXPECT_EQ(triangles_in(conversion.files[0]), 12);
  const std::string file = read_all(conversion.files[0]);
  EXPECT_EQ(number_after(file, "NumberOfPoints=\""), 8);
  EXPECT_NE(file.find("encoding=\"raw\""), std::string::npos);
  EXPECT_EQ(file.find("compressor"), std::string::npos);
  const std::string point_data =
      file.substr(file.find("<PointData"), file.find("</PointData>") - file.find("<PointData"));
  EXPECT_NE(point_data.find("Name=\"pressure\""), std::string::npos);
  EXPECT_NE(point_data.find("Name=\"velocity\""), std::string::npos);
  EXPECT_NE(point_data.find("RangeMin=\"7\""), std::string::npos);  // the cell's value on each point
}

TEST(VtkChild, BrokenLegacyFilesGiveOneLine) {
  NEEDS_VTK();
  const TemporaryFolder folder;
  std::string text = cube_file;
  EXPECT_NE(error_of(folder / "missing.vtk").find("cannot be opened"), std::string::npos);
  EXPECT_NE(error_of(write(folder, "empty.vtk", "")), "");
  EXPECT_NE(error_of(write(folder, "cut.vtk", text.substr(0, 120))), "");
  EXPECT_NE(error_of(write(folder, "huge.vtk", text.replace(text.find("POINTS 8"), 8, "POINTS 9000000000"))), "");
  text = cube_file;
  const std::string astray = error_of(write(folder, "astray.vtk", text.replace(text.find("8 0 1"), 5, "8 0 99")));
  EXPECT_NE(astray.find("a cell refers to point 99 of 8"), std::string::npos) << astray;
}

TEST(VtkChild, EveryTruncationEndsWell) {
  NEEDS_VTK();
  const TemporaryFolder folder;
  const std::string text = cube_file;
  for (std::size_t length = 0; length < text.size(); length += 37) try {
      const VtkConversion conversion = convert_with_vtk(write(folder, "cut.vtk", text.substr(0, length)));
      EXPECT_EQ(triangles_in(conversion.files.at(0)), 12) << length;  // only arrays may be missing
    } catch (const Error& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    }
}

constexpr const char* grid_file = R"(<VTKFile type="StructuredGrid" version="0.1" byte_order="LittleEndian">
<StructuredGrid WholeExtent="0 2 0 1 0 1"><Piece Extent="0 2 0 1 0 1">
<PointData><DataArray type="Float32" Name="ARRAY" format="ascii">1 2 3 4 5 6 7 8 9 10 11 12</DataArray></PointData>
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0 0 0 1 1 0 1 2 0 1 0 1 1 1 1 1 2 1 1</DataArray></Points>
</Piece></StructuredGrid></VTKFile>
)";

std::string grid_with(const std::string& array) {
  std::string text = grid_file;
  return text.replace(text.find("ARRAY"), 5, array);
}

TEST(VtkChild, StructuredGridGivesItsOuterSurface) {
  NEEDS_VTK();
  const TemporaryFolder folder;
  const VtkConversion conversion = convert_with_vtk(write(folder, "grid.vts", grid_with("p")));
  EXPECT_EQ(triangles_in(conversion.files.at(0)), 20);  // two cubes side by side: 10 quads
}

TEST(VtkChild, BlocksAreAppendedAndKeepAllArrays) {
  NEEDS_VTK();
  const TemporaryFolder folder;
  write(folder, "one.vts", grid_with("p"));
  write(folder, "two.vts", grid_with("q"));
  const VtkConversion conversion =
      convert_with_vtk(write(folder, "both.vtm",
                             "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><DataSet "
                             "index=\"0\" file=\"one.vts\"/>"
                             "<DataSet index=\"1\" file=\"two.vts\"/></vtkMultiBlockDataSet></VTKFile>"));
  EXPECT_EQ(triangles_in(conversion.files.at(0)), 40);
  const std::string file = read_all(conversion.files[0]);
  EXPECT_NE(file.find("Name=\"p\""), std::string::npos);
  EXPECT_NE(file.find("Name=\"q\""), std::string::npos);
}

TEST(VtkChild, EnSightTimeSteps) {
  NEEDS_VTK();
  const TemporaryFolder folder;
  write(
      folder, "mesh.geo",
      "one\ntwo\nnode id off\nelement id off\npart\n         1\nplate\ncoordinates\n         4\n"
      " 0.00000e+00\n 1.00000e+00\n 1.00000e+00\n 0.00000e+00\n 0.00000e+00\n 0.00000e+00\n 1.00000e+00\n 1.00000e+00\n"
      " 0.00000e+00\n 0.00000e+00\n 0.00000e+00\n 0.00000e+00\nquad4\n         1\n         1         2         3       "
      "  4\n");
  const std::string values =
      "x\npart\n         1\ncoordinates\n 1.00000e+00\n 2.00000e+00\n 3.00000e+00\n 4.00000e+00\n";
  write(folder, "p.0", values);
  write(folder, "p.1", values);
  const VtkConversion conversion = convert_with_vtk(
      write(folder, "run.case",
            "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: mesh.geo\nVARIABLE\nscalar per node: 1 pressure "
            "p.*\nTIME\ntime set: 1\n"
            "number of steps: 2\nfilename start number: 0\nfilename increment: 1\ntime values: 0.5 1.5\n"));
  EXPECT_EQ(conversion.times, (std::vector<double>{0.5, 1.5}));
  ASSERT_EQ(conversion.files.size(), 2u);
  for (const fs::path& file : conversion.files) {
    EXPECT_EQ(triangles_in(file), 2);
    EXPECT_NE(read_all(file).find("Name=\"pressure\""), std::string::npos);
  }
}

TEST(VtkChild, OpenFoamPatches) {
  NEEDS_VTK();
  const TemporaryFolder folder;
  const auto header = [](const std::string& type, const std::string& object) {
    return "FoamFile\n{\n version 2.0;\n format ascii;\n class " + type + ";\n object " + object + ";\n}\n";
  };
  write(folder, "system/controlDict",
        header("dictionary", "controlDict") +
            "startFrom latestTime;\nstartTime 0;\n"
            "endTime 1;\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval 1;\n");
  const std::string mesh = "constant/polyMesh/";
  write(folder, mesh + "points",
        header("vectorField", "points") +
            "8\n(\n(0 0 0)\n(1 0 0)\n(1 1 0)\n(0 1 0)\n(0 0 1)\n(1 0 1)\n(1 1 1)\n(0 1 1)\n)\n");
  write(folder, mesh + "faces",
        header("faceList", "faces") +
            "6\n(\n4(0 3 2 1)\n4(4 5 6 7)\n4(0 1 5 4)\n4(1 2 6 5)\n4(2 3 7 6)\n4(3 0 4 7)\n)\n");
  write(folder, mesh + "owner", header("labelList", "owner") + "6\n(\n0\n0\n0\n0\n0\n0\n)\n");
  write(folder, mesh + "neighbour", header("labelList", "neighbour") + "0\n(\n)\n");
  write(folder, mesh + "boundary",
        header("polyBoundaryMesh", "boundary") +
            "2\n(\nfloor\n{\n type wall;\n inGroups 1(wall);\n nFaces 1;\n startFace 0;\n}\n"
            "rest\n{\n type patch;\n nFaces 5;\n startFace 1;\n}\n)\n");
  write(folder, "0/U",
        header("volVectorField", "U") +
            "dimensions [0 1 -1 0 0 0 0];\ninternalField uniform (0 0 0);\n"
            "boundaryField\n{\nfloor\n{\n type fixedValue;\n value uniform (1 2 3);\n}\n"
            "rest\n{\n type fixedValue;\n value uniform (1 2 3);\n}\n}\n");
  const VtkConversion conversion = convert_with_vtk(write(folder, "run.foam", ""));
  ASSERT_FALSE(conversion.files.empty());
  EXPECT_EQ(triangles_in(conversion.files[0]), 12);  // not once more for the inner mesh or the group of walls
  const std::string file = read_all(conversion.files[0]);
  EXPECT_NE(file.find("Name=\"U\""), std::string::npos);
  EXPECT_NE(file.find("RangeMin=\"3.7416"),
            std::string::npos);  // |(1, 2, 3)|: the patches' values, not the cell's zero
  EXPECT_EQ(conversion.parts, (std::vector<std::string>{"floor", "rest"}));
  const VtkConversion floor = convert_with_vtk(folder / "run.foam", "fl*r");
  EXPECT_EQ(triangles_in(floor.files.at(0)), 2);
  EXPECT_EQ(triangles_in(convert_with_vtk(folder / "run.foam", "floor,rest").files.at(0)), 12);
  EXPECT_EQ(triangles_in(convert_with_vtk(folder / "run.foam", "internalMesh").files.at(0)), 12);
  const std::string error = error_of(folder / "run.foam", "wings");
  EXPECT_NE(error.find("no part wings"), std::string::npos) << error;
  EXPECT_NE(error.find("floor"), std::string::npos) << error;
}

TEST(VtkChild, BlocksAreChosenByName) {
  NEEDS_VTK();
  const TemporaryFolder folder;
  write(folder, "one.vts", grid_with("p"));
  const fs::path file =
      write(folder, "both.vtm",
            "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><DataSet index=\"0\" "
            "name=\"hull\" file=\"one.vts\"/><DataSet index=\"1\" file=\"one.vts\"/>"
            "</vtkMultiBlockDataSet></VTKFile>");
  const VtkConversion hull = convert_with_vtk(file, "hull");
  EXPECT_EQ(triangles_in(hull.files.at(0)), 20);
  EXPECT_EQ(hull.parts.size(), 2u);
  EXPECT_NE(error_of(file, "sail").find("its parts are hull"), std::string::npos) << error_of(file, "sail");
  EXPECT_NE(error_of(folder / "one.vts", "hull").find("no parts"), std::string::npos);
}

TEST(VtkChild, SeveralFilesAndListsOfThemAreSteps) {
  NEEDS_VTK();
  const TemporaryFolder folder;
  write(folder, "one.vts", grid_with("p"));
  const std::string block =
      "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><DataSet index=\"0\" "
      "name=\"hull\" file=\"one.vts\"/></vtkMultiBlockDataSet></VTKFile>";
  const fs::path first = write(folder, "a_0.vtm", block), second = write(folder, "a_1.vtm", block);
  EXPECT_EQ(open_surface({first, second}).times, (std::vector<double>{0, 1}));
  EXPECT_EQ(open_surface({first, second}, "hull").load(1).triangles.size(), 20u);
  const fs::path list = write(folder, "a.vtm.series",
                              "{\"file-series-version\": \"1.0\", \"files\": [{\"name\": \"a_0.vtm\", \"time\": 0.5}, "
                              "{\"name\": \"a_1.vtm\", \"time\": 2}]}");
  EXPECT_EQ(open_surface({list}).times, (std::vector<double>{0.5, 2}));
  EXPECT_EQ(open_surface({list}, "h?ll").load(1).triangles.size(), 20u);
  EXPECT_THROW(open_surface({list}, "sail"), Error);
}

TEST(VtkChild, PartsAreOnlyThoseOfFilesThatVtkReads) {
  const TemporaryFolder folder;
  const fs::path file = write(folder, "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(open_surface({file}).load(0).triangles.size(), 1u);
  EXPECT_THROW(open_surface({file}, "hull"), Error);
}

TEST(VtkChild, RotatingDisk) {
  NEEDS_VTK();
  NACRE_NEEDS_SHARED_DATA("flow/disk-out");
  const fs::path disk = test::shared_data("flow/disk-out");
  EXPECT_EQ(triangles_in(convert_with_vtk(disk / "disk_out_ref.ex2").files.at(0)), 3976);
  const VtkConversion surface = convert_with_vtk(disk / "SurfaceVectors.vtk");
  EXPECT_EQ(triangles_in(surface.files.at(0)), 756);
  EXPECT_NE(read_all(surface.files[0]).find("Name=\"V\""), std::string::npos);
}

TEST(VtkChild, MalformedFilesEndWell) {
  NEEDS_VTK();
  NACRE_NEEDS_SHARED_DATA("malformed/e-vtk");
  const fs::path folder = test::shared_data("malformed/e-vtk");
  std::size_t read = 0, refused = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".vtk") continue;
    if (error_of(entry.path()).empty())
      ++read;
    else
      ++refused;
  }
  EXPECT_EQ(refused, 5u);  // lines or points only: faults, Line, PolyLine, PolyVertex, Vertex
  EXPECT_EQ(read, 15u);
}

}  // namespace
}  // namespace nacre
