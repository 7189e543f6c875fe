// Nacre: writes surfaces as glTF 2.0 (.glb), for slides and browsers.
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "engine/io/mesh_format_writers.hpp"
#include "engine/system/output_file.hpp"
#include "engine/system/utf8.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

static_assert(std::endian::native == std::endian::little);  // as the format demands
constexpr int float_numbers = 5126, unsigned_numbers = 5125, vertex_data = 34962, index_data = 34963;

/// Hues a golden angle apart, in linear RGB.
json gltf_colour(std::int32_t tag) {
  json rgb = json::array();
  const double hue = 0.61803398875 * tag;
  for (int channel = 0; channel < 3; ++channel) {
    const double at = hue + channel / 3.0;
    rgb.push_back(0.45 + 0.35 * std::cos(2 * 3.14159265358979 * at));
  }
  rgb.push_back(1.0);
  return rgb;
}

/// One interface, with points of its own: normals do not go around the corner to the next one.
struct GltfPart {
  std::vector<Vec3f> points, normals;
  std::vector<std::uint32_t> corners;
  Vec3f low{0, 0, 0}, high{0, 0, 0};
};

GltfPart gltf_part(const MeshParts& mesh, const MaterialPair& pair, const Vec3d& centre) {
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> number(mesh.points.size(), none);
  std::vector<Vec3d> sums;
  GltfPart part;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (mesh.materials[i] != pair) continue;
    const Triangle& t = mesh.triangles[i];
    const Vec3d a = mesh.points[t.a], normal = cross(mesh.points[t.b] - a, mesh.points[t.c] - a);
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& n = number[t[k]];
      if (n == none) {
        n = std::uint32_t(part.points.size());
        part.points.push_back(Vec3f(mesh.points[t[k]] - centre));
        sums.emplace_back(0, 0, 0);
      }
      sums[n] += normal;
      part.corners.push_back(n);
    }
  }
  for (const Vec3d& sum : sums)
    part.normals.push_back(length(sum) > 0 ? Vec3f(normalized(sum)) : Vec3f(0, 0, 1));  // must have length 1
  part.low = part.high = part.points.front();
  for (const Vec3f& p : part.points) part.low = min(part.low, p), part.high = max(part.high, p);
  return part;
}

/// The JSON and the numbers of a file.
class GltfAsset {
 public:
  GltfAsset(const Vec3d& centre, const std::string& origin) {
    const double half = std::sqrt(0.5);  // a quarter turn about x: (x, y, z) becomes (x, z, -y)
    json_ = {{"asset", {{"version", "2.0"}, {"generator", "Nacre"}}},
             {"scene", 0},
             {"scenes", json::array({json{{"nodes", json::array({0})}}})},
             {"nodes", json::array()},
             {"meshes", json::array()},
             {"materials", json::array()},
             {"buffers", json::array()},
             {"bufferViews", json::array()},
             {"accessors", json::array()}};
    if (!origin.empty()) json_["asset"]["extras"] = {{"origin", json::parse(origin)}};
    json_["nodes"].push_back({{"name", "mesh"},
                              {"rotation", {-half, 0, 0, half}},
                              {"translation", {centre.x, centre.z, -centre.y}},
                              {"children", json::array()}});
  }

  void add(const MeshParts::Group& group, const GltfPart& part) {
    const std::string name = in_utf8(group.name, 200);
    const std::size_t points = add_numbers(part.points, float_numbers, "VEC3", vertex_data, part.points.size());
    json_["accessors"][points]["min"] = {part.low.x, part.low.y, part.low.z};
    json_["accessors"][points]["max"] = {part.high.x, part.high.y, part.high.z};
    const std::size_t normals = add_numbers(part.normals, float_numbers, "VEC3", vertex_data, part.normals.size());
    const std::size_t corners = add_numbers(part.corners, unsigned_numbers, "SCALAR", index_data, part.corners.size());
    const std::size_t number = json_["meshes"].size();
    json_["materials"].push_back(
        {{"name", name},
         {"doubleSided", true},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", gltf_colour(group.tag)}, {"metallicFactor", 0}, {"roughnessFactor", 0.8}}}});
    const json primitive = {
        {"attributes", {{"POSITION", points}, {"NORMAL", normals}}}, {"indices", corners}, {"material", number}};
    json_["meshes"].push_back({{"name", name}, {"primitives", json::array({primitive})}});
    json_["nodes"].push_back({{"name", name}, {"mesh", number}});
    json_["nodes"][0]["children"].push_back(number + 1);
  }

  void write(const fs::path& file) {
    json_["buffers"].push_back({{"byteLength", numbers_.size()}});
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + text.size() + 8 + numbers_.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
      throw Error("cannot write " + file.string(), "glTF has at most 4 GiB in one file", "use .ply or .vtp");
    OutputFile out(file);
    const auto chunk = [&](const char* type, const std::string& bytes) {
      const auto size = std::uint32_t(bytes.size());
      out.write(&size, 4);
      out.write(type, 4);
      out.write(bytes);
    };
    const std::array<std::uint32_t, 2> head{2, std::uint32_t(total)};
    out.write("glTF");
    out.write(head.data(), 8);
    chunk("JSON", text);
    chunk("BIN\0", numbers_);  // NOLINT(bugprone-string-literal-with-embedded-nul): four bytes
    out.commit();
  }

 private:
  template <class T>
  std::size_t add_numbers(const std::vector<T>& values, int type, const char* shape, int target, std::size_t count) {
    const std::size_t bytes = values.size() * sizeof(T), view = json_["bufferViews"].size();
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", numbers_.size()}, {"byteLength", bytes}, {"target", target}});
    numbers_.append(reinterpret_cast<const char*>(values.data()), bytes);
    json_["accessors"].push_back({{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
    return view;
  }

  json json_;
  std::string numbers_;
};

}  // namespace

void write_gltf(const fs::path& file, const MeshParts& mesh) {
  Vec3d low = mesh.points.front(), high = low;
  for (const Vec3d& p : mesh.points) low = min(low, p), high = max(high, p);
  const Vec3d centre = (low + high) * 0.5;
  GltfAsset asset(centre, mesh.origin);
  for (const auto& [pair, group] : mesh.interfaces) asset.add(group, gltf_part(mesh, pair, centre));
  asset.write(file);
}

}  // namespace nacre
