// Nacre: files cut short and files with flipped bits: a surface or an Error, never anything else.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/engine/io/io_test_files.hpp"

namespace nacre::test {
namespace {

/// What the rest of the program relies on.
void expect_sound(const Surface& surface) {
  ASSERT_FALSE(surface.triangles.empty());
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) ASSERT_LT(t[k], surface.points.size());
  for (const Vec3d& p : surface.points) ASSERT_TRUE(is_finite(p));
  for (const PointArray& array : surface.arrays) {
    ASSERT_EQ(array.values.size(), surface.points.size() * std::size_t(array.components)) << array.name;
    for (const float value : array.values) ASSERT_TRUE(std::isfinite(value)) << array.name;
  }
}

/// Opens and describes the file; anything but success or a one-line Error fails the test.
void try_file(const fs::path& path) {
  try {
    const SurfaceSeries series = open_surface({path});
    ASSERT_GE(series.steps(), 1u);
    expect_sound(series.load(0));
    expect_sound(series.load(series.steps() - 1));
  } catch (const Error& error) {
    EXPECT_FALSE(contains(error.what(), "\n"));
    EXPECT_TRUE(contains(error.what(), path.filename().string())) << error.what();
  }
  try {
    describe(path);
  } catch (const Error&) {
  }
}

class DamagedFiles : public ReaderTest {
 protected:
  void cut_everywhere(const std::string& name, const std::string& bytes) {
    for (int part = 0; part < 16; ++part) try_file(write(name, bytes.substr(0, bytes.size() * part / 16)));
    try_file(write(name, bytes.substr(0, bytes.size() - 1)));
  }

  /// Half of the flips fall into the first 2,000 bytes, where the headers are.
  void flip_bytes(const std::string& name, const std::string& bytes, int times) {
    std::mt19937 random(20261120);
    for (int i = 0; i < times; ++i) {
      std::string damaged = bytes;
      const int flips = 1 + int(random() % 8);
      for (int k = 0; k < flips; ++k) {
        const std::size_t range = i % 2 ? std::min<std::size_t>(bytes.size(), 2000) : bytes.size();
        damaged[random() % range] = char(random());
      }
      try_file(write(name, damaged));
    }
  }

  void damage(const std::string& name, const std::string& bytes) {
    cut_everywhere(name, bytes);
    flip_bytes(name, bytes, 40);
  }
};

TEST_F(DamagedFiles, SmallTextFiles) {
  damage("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf -4/1/1 -3//2 -1/1\n");
  damage("a.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n");
  damage("a.stl",
         "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
         "0\nendloop\nendfacet\nendsolid\n");
  damage("a.ply",
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty "
         "float p\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 2\n0 1 0 3\n3 0 1 2\n");
  damage(
      "a.vtp",
      "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><PointData><DataArray "
      "type=\"Float32\" Name=\"p\" format=\"ascii\">1 2 3</DataArray></PointData><Points><DataArray type=\"Float32\" "
      "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points><Polys><DataArray "
      "type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray><DataArray type=\"Int32\" "
      "Name=\"offsets\" format=\"ascii\">3</DataArray></Polys></Piece></PolyData></VTKFile>");
}

TEST_F(DamagedFiles, RealFiles) {
  NACRE_NEEDS_SHARED_DATA("");
  for (const char* name :
       {"malformed/e-misc/platonic_shelf.ply", "malformed/e-misc/platonic_shelf_big_endian.ply",
        "malformed/e-misc/multi.ply", "malformed/e-misc/mirror.ply", "malformed/e-misc/negative_indices.obj",
        "malformed/e-misc/whitespace.off", "malformed/e-assimp/PLY/cube_uv.ply", "meshes/defects/shared.STL",
        "meshes/defects/multibody.stl", "meshes/stl-defects/block/exact-bad.stl",
        "malformed/e-vtk/202-t-edges-appended.vtp", "malformed/e-vtk/202-t.vtp",
        "flow/artery/artery_wallshear_5steps.vtp", "flow/plot3d/bluntfin_fin_j1.vtp",
        "flow/disk-out/disk_out_ref_surface.vtp"}) {
    SCOPED_TRACE(name);
    const fs::path path = shared_data(name);
    damage(path.filename().string(), read_all(path));
  }
}

}  // namespace
}  // namespace nacre::test
