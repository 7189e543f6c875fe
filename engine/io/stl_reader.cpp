// Nacre: STL, text and binary; corners at exactly the same position become one point.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <unordered_map>

#include "engine/io/byte_order.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/readers.hpp"
#include "engine/io/text_cursor.hpp"

namespace nacre {
namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t facet_bytes = 50;

/// Numbers positions: equal positions get the same number.
class PointMerger {
 public:
  explicit PointMerger(RawMesh& mesh) : mesh_(mesh) {}

  void reserve(std::size_t corners) { numbers_.reserve(corners / 5); }

  std::int64_t operator()(Vec3d p) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += 0.0;  // -0 and 0 are one position
    const auto [entry, added] = numbers_.try_emplace(p, std::int64_t(mesh_.points.size()));
    if (added) mesh_.points.push_back(p);
    return entry->second;
  }

 private:
  struct SameBits {
    bool operator()(const Vec3d& a, const Vec3d& b) const { return bits(a.x, b.x) && bits(a.y, b.y) && bits(a.z, b.z); }
    static bool bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
  };
  struct Hash {
    std::size_t operator()(const Vec3d& p) const {
      std::uint64_t h = 0;
      for (int axis = 0; axis < 3; ++axis) {
        h = (h ^ std::bit_cast<std::uint64_t>(p[axis])) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
      }
      return h;
    }
  };

  RawMesh& mesh_;
  std::unordered_map<Vec3d, std::int64_t, Hash, SameBits> numbers_;
};

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

/// Many binary files also begin with "solid". What counts is whether the size fits, then whether text follows.
bool is_text(const std::string& bytes) {
  if (bytes.size() >= header_bytes) {
    const auto facets = load_number<std::uint32_t>(bytes.data() + 80, std::endian::little);
    if (facets > 0 && header_bytes + facet_bytes * facets == bytes.size()) return false;
  }
  const std::string head = lower(std::string_view(bytes).substr(0, 4096));
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first == head.npos || head.compare(first, 5, "solid") != 0) return false;
  return bytes.size() < header_bytes || head.find("facet") != head.npos || head.find("endsolid") != head.npos ||
         head.find('\0') == head.npos;
}

RawMesh read_text(const std::string& bytes, const std::filesystem::path& path) {
  RawMesh mesh;
  PointMerger number(mesh);
  TextCursor text(bytes);
  std::size_t corners = 0;
  bool in_facet = false;
  while (!text.at_end()) {
    const std::string word = lower(text.word());
    if (word == "vertex") {
      Vec3d p;
      if (!text.number(p.x) || !text.number(p.y) || !text.number(p.z))
        fail_reading(path, fmt::format("a vertex is not three numbers, line {}", text.line()));
      mesh.add_corner(number(p));
      ++corners;
    } else if (word == "facet") {
      in_facet = true;
    } else if (word == "endloop") {
      if (corners > 0) mesh.close_polygon();
      corners = 0;
    } else if (word == "endfacet") {
      if (corners > 0) mesh.close_polygon();  // a loop that was not ended
      corners = 0;
      in_facet = false;
    } else if (word == "solid" || word == "endsolid") {
      text.rest_of_line();  // a name, which may be any text
    }
  }
  if (in_facet || corners > 0) fail_reading(path, "it ends inside a facet");
  return mesh;
}

RawMesh read_binary(const std::string& bytes, const std::filesystem::path& path) {
  if (bytes.size() < header_bytes)
    fail_reading(path, "it is neither text nor binary STL", "check that it is an STL file");
  const std::size_t facets = load_number<std::uint32_t>(bytes.data() + 80, std::endian::little);
  const std::size_t room = (bytes.size() - header_bytes) / facet_bytes;
  if (facets > room)
    fail_reading(path, fmt::format("its header promises {} triangles, but there are bytes for {}", facets, room));
  RawMesh mesh;
  if (bytes.size() - header_bytes > facets * facet_bytes)
    mesh.warnings.push_back(fmt::format("{} bytes after the last triangle are ignored.",
                                        bytes.size() - header_bytes - facets * facet_bytes));
  PointMerger number(mesh);
  number.reserve(3 * facets);
  mesh.connectivity.reserve(3 * facets);
  mesh.offsets.reserve(facets + 1);
  for (std::size_t i = 0; i < facets; ++i) {
    const char* facet = bytes.data() + header_bytes + i * facet_bytes + 12;
    for (int corner = 0; corner < 3; ++corner, facet += 12)
      mesh.add_corner(
          number({load_number<float>(facet, std::endian::little), load_number<float>(facet + 4, std::endian::little),
                  load_number<float>(facet + 8, std::endian::little)}));
    mesh.close_polygon();
  }
  return mesh;
}

}  // namespace

RawMesh read_stl(std::string bytes, const std::filesystem::path& path) {
  return is_text(bytes) ? read_text(bytes, path) : read_binary(bytes, path);
}

}  // namespace nacre
