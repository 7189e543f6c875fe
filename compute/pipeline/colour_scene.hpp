// Nacre: the colours of a picture of flow, on the device.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "compute/device/arena.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/raycast/render.hpp"

namespace nacre {

/// Sets what `options` say of colours, background and back faces. The arrays last as long as the caller's scope of the
/// arena.
template <class Scene>
void colour_scene(Arena& arena, const RenderOptions& options, Scene& scene) {
  const auto linear = [](const std::array<float, 3>& c) { return to_linear({c[0], c[1], c[2]}); };
  if (!options.scalar.empty()) {
    Array<float> scalar = arena.temporary<float>(options.scalar.size());
    scalar.upload(options.scalar);
    std::vector<Float4> table;
    for (const auto& c : options.colours) table.push_back({linear(c).x, linear(c).y, linear(c).z, 1});
    Array<Float4> colours = arena.temporary<Float4>(table.size());
    colours.upload(table);
    scene.scalar = scalar.data();
    scene.colours = colours.data();
    scene.below = linear(options.below.value_or(options.colours.front()));
    scene.above = linear(options.above.value_or(options.colours.back()));
    scene.no_number = linear(options.no_number);
    scene.low = float(options.low);
    scene.high = options.high > options.low ? float(options.high) : std::nextafter(float(options.low), 1e30f);
  }
  scene.background = linear(options.background);
  scene.background_alpha = options.transparent ? 0.0f : 1.0f;
  scene.neutral_backs = options.back_faces == BackFaces::neutral;
  scene.hidden_backs = options.back_faces == BackFaces::hidden;
}

}  // namespace nacre
