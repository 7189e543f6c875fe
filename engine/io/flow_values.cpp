// Nacre: writes the values of a flow to a file.
#include "engine/io/flow_values.hpp"

#include <fmt/format.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/vtp_writer.hpp"

namespace nacre {
namespace {

const std::string closest_point_name = "closest_point";

std::vector<PointArray> arrays_of(const FlowValues& v, const MoreArrays& more) {
  const std::size_t n = v.value.size();
  const auto vectors = [&](std::string name, const std::vector<Vec3f>& from) {
    PointArray array{std::move(name), 3, std::vector<float>(3 * n)};
    for (std::size_t i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k) array.values[3 * i + k] = from[i][k];
    return array;
  };
  std::vector<PointArray> arrays{{"value", 1, v.value}, vectors("velocity", v.velocity), vectors("normal", v.normal)};
  if (more)
    for (PointArray& array : more(v.closest_point)) arrays.push_back(std::move(array));
  return arrays;
}

}  // namespace

void write_flow_values(const FlowValues& values, const std::filesystem::path& file, double time,
                       const std::string& origin, const MoreArrays& more,
                       const std::function<void()>& before_it_appears) {
  const PointPositions closest{closest_point_name, values.closest_point};
  write_vtp(file, std::span<const Vec3d>(values.centre), {}, arrays_of(values, more), time, {}, xml_origin(origin),
            std::span(&closest, 1), before_it_appears);
}

std::filesystem::path flow_values_piece(const std::filesystem::path& file, int k) {
  return file.parent_path() / fmt::format("{}_{}.vtp", file.stem().string(), k);
}

void write_flow_values_list(const std::filesystem::path& file, std::span<const int> parts, const std::string& origin,
                            const MoreArrays& more) {
  std::vector<std::string> names;
  for (const int k : parts) names.push_back(flow_values_piece(file, k).filename().string());
  write_pvtp(file, names, arrays_of({}, more), std::span(&closest_point_name, 1), xml_origin(origin));
}

}  // namespace nacre
