// Nacre: tests of INR, VTI and the volumes that go through VTK.
#include "engine/io/vtk_child.hpp"
#include "tests/engine/io/volume_files.hpp"

namespace nacre::test {
namespace {

using Inr = VolumeTest;
using Vti = VolumeTest;
using VtkVolume = VolumeTest;
using VolumeRegistry = VolumeTest;

#define NEEDS_VTK() \
  if (!vtk_child_available()) GTEST_SKIP() << "nacre-vtk-import was not built (VTK not found)"

std::string inr(const std::string& fields, const std::string& data) {
  std::string header = "#INRIMAGE-4#{\nXDIM=3\nYDIM=2\nZDIM=2\nVDIM=1\n" + fields;
  header.resize(252, '\n');
  return header + "##}\n" + data;
}

const std::string bytes = counting<std::uint8_t>(12);
const char* byte_fields = "TYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=decm\nVX=1\nVY=2\nVZ=3\n";

TEST_F(Inr, PlainAndPacked) {
  for (const Volume& volume :
       {read("a.inr", inr(byte_fields, bytes)), read("a.inr.gz", gzipped(inr(byte_fields, bytes)))}) {
    EXPECT_EQ(values_of(volume), count_up(12));
    EXPECT_STREQ(value_type_name(volume.values), "uint8");
    expect_near(volume.spacing, {1, 2, 3});
    EXPECT_TRUE(volume.warnings.empty());
  }
}

TEST_F(Inr, TypesOrdersAndPlaces) {
  const auto fields = [](const std::string& type, int bits, const std::string& cpu) {
    return "TYPE=" + type + "\nPIXSIZE=" + std::to_string(bits) + " bits\nCPU=" + cpu + "\nVX=1\nVY=1\nVZ=1\nTX=5\n";
  };
  const auto check = [&](const Volume& volume, const char* name) {
    EXPECT_EQ(values_of(volume), count_up(12)) << name;
    EXPECT_STREQ(value_type_name(volume.values), name);
    expect_near(volume.origin, {5, 0, 0});
  };
  check(read("a.inr", inr(fields("signed fixed", 16, "sun"), counting<std::int16_t>(12, true))), "int16");
  check(read("a.inr", inr(fields("unsigned fixed", 32, "pc"), counting<std::uint32_t>(12))), "uint32");
  check(read("a.inr", inr(fields("float", 32, "decm"), counting<float>(12))), "float");
  check(read("a.inr", inr(fields("float", 64, "sgi"), counting<double>(12, true))), "double");
}

TEST_F(Inr, Scale) {
  const std::vector<double> values = values_of(read("a.inr", inr(std::string(byte_fields) + "SCALE=2**-1\n", bytes)));
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(values[i], 0.5 * double(i));
}

TEST_F(Inr, WhatIsDamagedIsAnError) {
  const std::string fields = byte_fields;
  const auto with = [&](const std::string& before, const std::string& after) {
    std::string content = inr(fields, bytes);
    return failure("a.inr", content.replace(content.find(before), before.size(), after));
  };
  EXPECT_TRUE(contains(failure("a.inr", inr(fields, bytes.substr(1))), "needs 12 bytes of values and holds 11"));
  EXPECT_TRUE(contains(with("VX=1", "VX=0"), "spacing along its axis 0 is zero"));
  EXPECT_TRUE(contains(with("VX=1", "VX=nan"), "not a number"));
  EXPECT_TRUE(contains(with("VDIM=1", "VDIM=3"), "3 values per voxel"));
  EXPECT_TRUE(contains(with("ZDIM=2", "ZDIM=1"), "flat image"));
  EXPECT_TRUE(contains(with("ZDIM=2", "ZDIM=x"), "ZDIM=x"));
  EXPECT_TRUE(contains(with("PIXSIZE=8", "PIXSIZE=7"), "PIXSIZE=7"));
  EXPECT_TRUE(contains(with("unsigned fixed", "packed"), "TYPE=packed"));
  EXPECT_TRUE(contains(with("##}", "###"), "header does not end"));
  EXPECT_TRUE(contains(with("XDIM=3", "XDIM=9999999999"), "implausible"));
  EXPECT_TRUE(contains(failure("a.inr", "something else"), "does not begin with"));
  EXPECT_TRUE(contains(failure("a.inr", inr("TYPE=float\nPIXSIZE=32 bits\n", counting<float>(12))), "no CPU"));
}

std::string vti(const std::string& attributes, const std::string& content) {
  return "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 2 0 1 0 1\" " +
         attributes + "><Piece Extent=\"0 2 0 1 0 1\">" + content + "</Piece></ImageData></VTKFile>";
}

std::string array(const std::string& type, const std::string& name, const std::string& numbers,
                  const std::string& more = "") {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\" " + more + ">" + numbers +
         "</DataArray>";
}

const std::string twelve = "0 1 2 3 4 5 6 7 8 9 10 11";

TEST_F(Vti, PointsInTheFilesType) {
  for (const char* type :
       {"UInt8", "Int8", "UInt16", "Int16", "UInt32", "Int32", "Int64", "UInt64", "Float32", "Float64"}) {
    const Volume volume = read(
        "a.vti", vti("Spacing=\"1 2 3\" Origin=\"4 5 6\"", "<PointData>" + array(type, "v", twelve) + "</PointData>"));
    EXPECT_EQ(values_of(volume), count_up(12)) << type;
    expect_near(volume.spacing, {1, 2, 3});
    expect_near(volume.origin, {4, 5, 6});
  }
  // A label that no float holds.
  const Volume large =
      read("a.vti", vti("Spacing=\"1 1 1\"",
                        "<PointData>" + array("Int32", "v", "16777217 1 2 3 4 5 6 7 8 9 10 11") + "</PointData>"));
  EXPECT_EQ(values_of(large)[0], 16777217);
}

TEST_F(
    Vti,
    DirectionTurnsTheAxes) {  // a third of a turn: x goes to y, y to z, z to x; rows of the matrix are the world's axes
  const Volume volume = read("a.vti", vti("Spacing=\"1 2 3\" Origin=\"4 5 6\" Direction=\"0 0 1 1 0 0 0 1 0\"",
                                          "<PointData>" + array("UInt8", "v", twelve) + "</PointData>"));
  expect_near(volume.axes[0], {0, 1, 0});
  expect_near(volume.axes[1], {0, 0, 1});
  expect_near(volume.axes[2], {1, 0, 0});
  expect_near(volume.spacing, {1, 2, 3});
  expect_near(volume.origin, {4, 5, 6});
}

TEST_F(Vti, CellsLieBetweenThePoints) {
  std::string content =
      vti("Spacing=\"1 2 3\"", "<CellData>" + array("UInt8", "labels", "1 2 3 4 5 6 7 8") + "</CellData>");
  for (std::size_t at = content.find("0 2 0 1 0 1"); at != content.npos; at = content.find("0 2 0 1 0 1"))
    content.replace(at, 11, "0 2 0 2 0 2");
  const Volume volume = read("a.vti", content);
  EXPECT_EQ(volume.dims, Int3(2, 2, 2));
  EXPECT_EQ(values_of(volume), (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}));
  expect_near(volume.origin, {0.5, 1, 1.5});
}

TEST_F(Vti, ChoosesTheScalars) {
  const Volume volume =
      read("a.vti",
           vti("Spacing=\"1 1 1\"",
               "<PointData Scalars=\"b\">" +
                   array("Float32", "v", twelve + " " + twelve + " " + twelve, "NumberOfComponents=\"3\"") +
                   array("Float32", "a", "9 9 9 9 9 9 9 9 9 9 9 9") + array("Float32", "b", twelve) + "</PointData>"));
  EXPECT_EQ(values_of(volume), count_up(12));
  ASSERT_EQ(volume.warnings.size(), 1u);
  EXPECT_TRUE(contains(volume.warnings[0], "array b is used, and a ignored"));
  EXPECT_TRUE(contains(failure("a.vti", vti("", "<PointData>" +
                                                    array("Float32", "v", twelve + " " + twelve + " " + twelve,
                                                          "NumberOfComponents=\"3\"") +
                                                    "</PointData>")),
                       "no array with one value per voxel"));
}

TEST_F(Vti, WhatIsDamagedIsAnError) {
  const std::string points = "<PointData>" + array("UInt8", "v", twelve) + "</PointData>";
  EXPECT_TRUE(contains(failure("a.vti", vti("Spacing=\"1 0 1\"", points)), "axis 1 is zero"));
  EXPECT_TRUE(contains(failure("a.vti", vti("Spacing=\"1 nan 1\"", points)), "not 3 numbers"));
  EXPECT_TRUE(contains(failure("a.vti", vti("Spacing=\"1 1 1\" Direction=\"1 1 0 0 1 0 0 0 1\"", points)), "sheared"));
  EXPECT_TRUE(contains(failure("a.vti", vti("", "<PointData>" + array("UInt8", "v", "1 2 3") + "</PointData>")),
                       "has 3 entries, 12 are needed"));
  EXPECT_EQ(read("a.vti", vti("", points)).warnings.size(), 1u);  // no spacing
}

TEST_F(VtkVolume, LegacyStructuredPoints) {
  NEEDS_VTK();
  const std::string content =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\n"
      "ORIGIN 1 2 3\nSPACING 1 2 3\nPOINT_DATA 12\nSCALARS v short 1\nLOOKUP_TABLE default\n" +
      twelve + "\n";
  const Volume volume = read("a.vtk", content);
  EXPECT_EQ(values_of(volume), count_up(12));
  EXPECT_STREQ(value_type_name(volume.values), "int16");
  expect_near(volume.spacing, {1, 2, 3});
  expect_near(volume.origin, {1, 2, 3});
  EXPECT_FALSE(is_volume_file(write("b.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n")));
}

TEST_F(VtkVolume, Slc) {
  NEEDS_VTK();
  const std::string header = "11111\n3 2 2 8\n1.0 2.0 3.0\n0 0 0 0\n1 1 Xrgb";
  const Volume volume = read("a.slc", header + bytes);
  EXPECT_EQ(values_of(volume), count_up(12));
  expect_near(volume.spacing, {1, 2, 3});
  EXPECT_NE(failure("cut.slc", header + bytes.substr(0, 8)), "");
  EXPECT_NE(failure("other.slc", "no slc"), "");
}

TEST_F(VtkVolume, WhatIsDamagedIsAnError) {
  NEEDS_VTK();
  const std::string head = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n";
  EXPECT_NE(failure("a.vtk", head + "DIMENSIONS 3 2 2\n"), "");
  EXPECT_NE(
      failure("a.vtk", head + "DIMENSIONS 3 2 2\nPOINT_DATA 12\nSCALARS v short 1\nLOOKUP_TABLE default\n1 2 3\n"), "");
  EXPECT_NE(failure("a.vtk", head + "DIMENSIONS 90000 90000 90000\nPOINT_DATA 729000000000000\nSCALARS v short 1\n"),
            "");
  EXPECT_NE(failure("a.vtk", head +
                                 "DIMENSIONS 3 2 2\nSPACING 1 0 1\nPOINT_DATA 12\nSCALARS v short 1\n"
                                 "LOOKUP_TABLE default\n" +
                                 twelve + "\n"),
            "");
}

TEST_F(VolumeRegistry, KnowsItsFiles) {
  for (const char* name : {"a.nrrd", "a.NHDR", "a.nii", "a.nii.gz", "a.hdr", "a.img.gz", "a.inr", "a.inr.gz", "a.vti",
                           "a.mha", "a.mhd", "a.slc"})
    EXPECT_TRUE(is_volume_file(name)) << name;
  for (const char* name : {"a.ply", "a.vtp", "a.nrrd.gz", "a", "a.vtk", "a.txt"})
    EXPECT_FALSE(is_volume_file(name)) << name;
  EXPECT_TRUE(contains(failure(folder_ / "missing.nrrd"), "no such file"));
  EXPECT_TRUE(contains(failure("a.xyz", "1 2 3"), "known are .nrrd .nhdr .nii .nii.gz"));
}

}  // namespace
}  // namespace nacre::test
