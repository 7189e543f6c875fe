// Nacre: presets.
#include "engine/run/presets.hpp"

#include <algorithm>
#include <vector>

#include "engine/scene/samples/phantoms.hpp"

namespace nacre {

void apply_thesis_preset(Settings& settings) {
  MeshParameters& m = settings.mesh;
  m.theta = 0.75;
  m.coarse_iterations = 0;
  m.iterations = 50;
  m.stagnation = 0.0015;
  m.add_below = 0.75;
  m.delete_above = 1.35;
  m.projection = "embedding";
  m.subcells = 3;
  m.smooth = 0;
  m.remesh = 0;
  m.by_density = false;
}

void apply_thesis_kernel(Settings& settings, bool cut_at_isovalues) {
  settings.mesh.kernel = cut_at_isovalues ? "b-spline" : "catmull-rom";
}

bool is_cut_at_isovalues(const Session& session) {
  const MaterialSettings& materials = session.settings.materials;
  if (!materials.isovalue.empty()) return true;
  if (materials.labels || !materials.threshold.empty()) return false;
  const std::vector<PhantomInfo> all = phantoms();
  return std::any_of(all.begin(), all.end(),
                     [&](const PhantomInfo& p) { return p.name == session.sample && !p.labelled; });
}

}  // namespace nacre
