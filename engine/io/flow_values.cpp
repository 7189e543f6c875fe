// Nacre: writes the values of a flow to a file.
#include "engine/io/flow_values.hpp"

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/vtp_writer.hpp"

namespace nacre {

void write_flow_values(const FlowMethod& flow, const std::filesystem::path& file, double time,
                       const std::string& origin,
                       const std::function<std::vector<PointArray>(std::span<const Vec3d>)>& dye) {
  const FlowValues v = flow.values();
  const std::size_t n = v.value.size();
  const auto vectors = [&](std::string name, const std::vector<Vec3f>& from) {
    PointArray array{std::move(name), 3, std::vector<float>(3 * n)};
    for (std::size_t i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k) array.values[3 * i + k] = from[i][k];
    return array;
  };
  std::vector<PointArray> arrays{{"value", 1, v.value}, vectors("velocity", v.velocity), vectors("normal", v.normal)};
  if (dye)
    for (PointArray& array : dye(v.closest_point)) arrays.push_back(std::move(array));
  const PointPositions closest{"closest_point", v.closest_point};
  write_vtp(file, std::span<const Vec3d>(v.centre), {}, arrays, time, {}, xml_origin(origin), std::span(&closest, 1));
}

}  // namespace nacre
