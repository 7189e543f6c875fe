// Nacre: small volumes, and runs of `nacre mesh` on them.
#pragma once

#include <cmath>
#include <functional>
#include <sstream>

#include "tests/app/program.hpp"

namespace nacre::test {

/// A run of a second at most: two balls that share a disk, 24 voxels along each side.
inline const Arguments small_mesh = {"mesh", "--sample", "two-spheres", "--detail", "24", "--quiet"};

/// The text of an NRRD volume: values in ASCII. `fields` are header lines beside type, dimension, sizes and encoding.
template <class T>
std::string nrrd(const Int3& dims, const std::string& type, const std::string& fields,
                 const std::function<T(int, int, int)>& value) {
  std::ostringstream text;
  text << "NRRD0004\ntype: " << type << "\ndimension: 3\nsizes: " << dims.x << ' ' << dims.y << ' ' << dims.z << '\n'
       << fields << "encoding: ascii\n\n";
  for (int k = 0; k < dims.z; ++k)
    for (int j = 0; j < dims.y; ++j)
      for (int i = 0; i < dims.x; ++i) text << value(i, j, k) << (i + 1 < dims.x ? ' ' : '\n');
  return text.str();
}

inline const std::string unit_spacing = "spacings: 1 1 1\n";

/// 1 in a ball of radius 5 about the middle of 16 x 16 x 16 voxels, else 0.
inline int ball(int i, int j, int k) {
  return (i - 7.5) * (i - 7.5) + (j - 7.5) * (j - 7.5) + (k - 7.5) * (k - 7.5) < 25;
}

inline std::string ball_nrrd(const std::string& fields = unit_spacing, const std::string& type = "uchar") {
  return nrrd<int>({16, 16, 16}, type, fields, ball);
}

class MeshTest : public AppTest {
 protected:
  /// A run on a file that must succeed; returns its report.
  nlohmann::json mesh(const std::string& file, const Arguments& more = {}) const {
    const Outcome run = nacre(Arguments{"mesh", file, "--quiet", "--report", path("report.json")} + more);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    return run.status == 0 ? read_json("report.json") : nlohmann::json();
  }

  /// A run on a file that must fail with this status, one line that holds `parts`, and no file left.
  void expect_refused(const std::string& file, int status, const Arguments& parts, const Arguments& more = {}) const {
    expect_failure(nacre(Arguments{"mesh", file, "--quiet", "--out", path("never.vtp")} + more), status, parts);
    EXPECT_FALSE(exists("never.vtp"));
  }
};

/// Every material closed, nothing wrong off the junctions.
inline void expect_sound(const nlohmann::json& report) {
  const nlohmann::json& mesh = report["mesh"];
  for (const char* flaw :
       {"boundary_edges", "nonmanifold_edges", "duplicate_triangles", "degenerate_triangles", "inconsistent_edges"})
    EXPECT_EQ(mesh[flaw], 0) << flaw;
  EXPECT_GT(mesh["triangles"], 0);
  for (const nlohmann::json& material : mesh["materials"]) EXPECT_EQ(material["closed"], true) << material;
}

}  // namespace nacre::test
