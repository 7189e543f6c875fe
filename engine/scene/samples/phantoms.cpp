// Nacre: built-in volumes, by name.
#include "engine/scene/samples/phantoms.hpp"

#include <fmt/format.h>

#include "compute/device/error.hpp"
#include "engine/scene/samples/phantom_kit.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/settings/edit_distance.hpp"

namespace nacre {
namespace {

constexpr int min_detail = 16, max_detail = 1024;

const std::vector<PhantomDefinition>& definitions() {
  static const std::vector<PhantomDefinition> all = [] {
    std::vector<PhantomDefinition> list{torso_phantom(), head_phantom(), heart_phantom(), lungs_phantom(),
                                        ribcage_phantom()};
    for (PhantomDefinition& definition : analytic_phantoms()) list.push_back(std::move(definition));
    return list;
  }();
  return all;
}

const PhantomDefinition* find(const std::string& name) {
  for (const PhantomDefinition& definition : definitions())
    if (definition.info.name == name) return &definition;
  return nullptr;
}

[[noreturn]] void throw_unknown(const std::string& name) {
  for (const SampleInfo& surface : samples())
    if (surface.name == name) throw Error(fmt::format("the sample '{}' is a surface", name), "", "nacre flow takes it");
  std::string known, advice;
  for (const PhantomDefinition& one : definitions()) {
    known += (known.empty() ? "" : ", ") + one.info.name;
    if (edit_distance(name, one.info.name) <= 2) advice = fmt::format("did you mean '{}'?", one.info.name);
  }
  throw Error(fmt::format("there is no volume sample '{}'", name), "the volume samples are " + known, advice);
}

/// The phantom's own grid, or one with `detail` voxels along the longest side that covers the same box.
PhantomGrid grid_of(const Int3& own, int detail) {
  const int longest = std::max({own.x, own.y, own.z});
  PhantomGrid grid;
  if (detail == 0) detail = longest;
  grid.unit = double(longest - 1) / (detail - 1);
  for (int axis = 0; axis < 3; ++axis) grid.dims[axis] = int(std::lround((own[axis] - 1) / grid.unit)) + 1;
  return grid;
}

}  // namespace

std::vector<PhantomInfo> phantoms() {
  std::vector<PhantomInfo> infos;
  for (const PhantomDefinition& definition : definitions()) infos.push_back(definition.info);
  return infos;
}

bool is_phantom(const std::string& name) { return find(name) != nullptr; }

Volume make_phantom(const std::string& name, int detail, const std::atomic<bool>* stop) {
  const PhantomDefinition* definition = find(name);
  if (!definition) throw_unknown(name);
  if (detail != 0 && (detail < min_detail || detail > max_detail))
    throw Error(
        fmt::format("the sample '{}' cannot be made with detail {}", name, detail), "",
        fmt::format("choose from {} to {} voxels along its longest side, or 0 for its own", min_detail, max_detail));
  PhantomGrid grid = grid_of(definition->info.dims, detail);
  grid.stop = stop;
  Phantom phantom;
  definition->make(grid, phantom);
  Volume volume;
  volume.name = name;
  volume.space = "left-posterior-superior";
  volume.dims = grid.dims;
  volume.spacing = Vec3d(grid.unit);
  if (definition->info.labelled)
    volume.values = std::move(phantom.labels);
  else
    volume.values = std::move(phantom.values);
  return volume;
}

}  // namespace nacre
