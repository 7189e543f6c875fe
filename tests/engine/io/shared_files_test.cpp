// Nacre: files that several processes read in shares. Threads act as processes.
#include <fmt/format.h>

#include <array>

#include "compute/device/error.hpp"
#include "engine/io/reader.hpp"
#include "tests/engine/io/io_test_files.hpp"
#include "tests/thread_ranks.hpp"

namespace nacre::test {
namespace {

class SharedFilesRead : public ReaderTest {
 protected:
  /// `squares` beside each other from x = `first` on, with a vector on their points that grows with `time`, a number
  /// on the squares, and perhaps an array that no other piece has.
  static std::string piece(int first, int squares, double time, bool another = false) {
    std::string points, polygons, ends, vectors, numbers, own;
    for (int k = 0; k <= squares; ++k)
      for (int side = 0; side < 2; ++side) {
        points += fmt::format("{} {} {} ", first + k, side, 0.1 * k * side);
        vectors += fmt::format("{} {} 1 ", time + first + k, side);
        own += "7 ";
      }
    for (int k = 0; k < squares; ++k) {
      polygons += fmt::format("{} {} {} {} ", 2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1);
      ends += fmt::format("{} ", 4 * k + 4);
      numbers += fmt::format("{} ", 10 * (first + k) + time);
    }
    const auto array = [](const char* name, const char* type, int components, const std::string& text) {
      return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">{}</DataArray>",
                         type, name, components, text);
    };
    return fmt::format("<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">",
                       2 * squares + 2, squares) +
           "<Points>" + array("p", "Float64", 3, points) + "</Points><Polys>" +
           array("connectivity", "Int32", 1, polygons) + array("offsets", "Int32", 1, ends) + "</Polys><PointData>" +
           array("v", "Float32", 3, vectors) + (another ? array("own", "Float32", 1, own) : "") +
           "</PointData><CellData>" + array("n", "Float32", 1, numbers) + "</CellData></Piece></PolyData></VTKFile>";
  }

  static std::string list(int step, int pieces) {
    std::string sources;
    for (int k = 0; k < pieces; ++k) sources += fmt::format("<Piece Source=\"{}_{}.vtp\"/>", step, k);
    return "<VTKFile type=\"PPolyData\"><PPolyData>" + sources + "</PPolyData></VTKFile>";
  }

  std::filesystem::path write_series(int pieces) {
    std::string entries;
    for (int step = 0; step < 2; ++step) {
      for (int k = 0; k < pieces; ++k)
        write(fmt::format("{}_{}.vtp", step, k), piece(20 * k, k == 1 ? 0 : 3 + 5 * k, step, k == 2));
      write(fmt::format("{}.pvtp", step), list(step, pieces));
      entries += fmt::format("<DataSet timestep=\"{}\" file=\"{}.pvtp\"/>", step, step);
    }
    return write("all.pvd", "<VTKFile type=\"Collection\"><Collection>" + entries + "</Collection></VTKFile>");
  }

  /// Everything at the corners of the triangles, in their order.
  static std::vector<double> corners_of(const Surface& surface, const Surface& values) {
    std::vector<double> all;
    for (const Triangle& t : surface.triangles)
      for (int k = 0; k < 3; ++k) {
        for (int axis = 0; axis < 3; ++axis) all.push_back(surface.points[t[k]][axis]);
        for (const PointArray& array : values.arrays)
          for (int c = 0; c < array.components; ++c)
            all.push_back(array.values[t[k] * std::size_t(array.components) + std::size_t(c)]);
      }
    return all;
  }
};

TEST_F(SharedFilesRead, HoldTogetherWhatOneProcessReads) {
  for (const int pieces : {1, 4}) {
    const std::filesystem::path file = write_series(pieces);
    const SurfaceSeries whole = open_surface({file});
    for (const int count : {1, 2, 3, 7}) {
      std::vector<std::array<std::vector<double>, 2>> each(static_cast<std::size_t>(count));
      on_ranks(count, [&](Ranks& ranks) {
        const SharedSeries shared = open_surface({file}, {}, ranks);
        const Surface first = shared.series.load(0);
        EXPECT_EQ(shared.series.times, whole.times);
        EXPECT_FALSE(shared.series.moves);
        EXPECT_EQ(shared.point_id.size(), first.points.size());
        EXPECT_TRUE(std::is_sorted(shared.point_id.begin(), shared.point_id.end()));
        for (std::size_t step : {0, 1})
          each[std::size_t(ranks.rank())][step] = corners_of(first, shared.series.load(step));
      });
      for (std::size_t step : {0, 1}) {
        std::vector<double> together;
        for (const auto& own : each) together.insert(together.end(), own[step].begin(), own[step].end());
        EXPECT_EQ(together, corners_of(whole.load(0), whole.load(step))) << pieces << " pieces, " << count;
      }
    }
  }
}

TEST_F(SharedFilesRead, AMissingPieceIsFoundByAll) {
  const std::filesystem::path file = write_series(4);
  std::filesystem::remove(file.parent_path() / "1_3.vtp");
  std::atomic<int> told = 0;
  on_ranks(3, [&](Ranks& ranks) {
    try {
      open_surface({file}, {}, ranks);
    } catch (const Error& error) {
      told += contains(error.what(), "1_3.vtp cannot be opened");
    }
  });
  EXPECT_EQ(told, 3);
}

TEST_F(SharedFilesRead, PiecesThatDifferAndThatMoveAreFound) {
  const std::filesystem::path file = write_series(4);
  std::filesystem::create_directory(file.parent_path() / "b");
  for (const char* name : {"0.pvtp", "0_0.vtp", "0_1.vtp", "0_2.vtp", "0_3.vtp"})
    std::filesystem::copy(file.parent_path() / name, file.parent_path() / "b" / name);
  write("b/0_2.vtp", piece(40, 14, 0));
  std::atomic<int> told = 0;
  on_ranks(2, [&](Ranks& ranks) {
    try {
      open_surface({file.parent_path() / (ranks.first() ? "0.pvtp" : "b/0.pvtp")}, {}, ranks);
    } catch (const Error& error) {
      told += contains(error.what(), "another input");
    }
  });
  EXPECT_EQ(told, 2);
  write("1_3.vtp", piece(61, 18, 1));
  std::atomic<int> moves = 0;
  on_ranks(3, [&](Ranks& ranks) { moves += open_surface({file}, {}, ranks).series.moves; });
  EXPECT_EQ(moves, 3);
}

}  // namespace
}  // namespace nacre::test
