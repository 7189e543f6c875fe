// Nacre: colours and camera of a picture of flow, on the device.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "compute/device/arena.hpp"
#include "compute/pipeline/flow_domain.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/raycast/render.hpp"

namespace nacre {

/// Sets what `options` say of colours, background and back faces. `values`: what to colour by, one for each embedded
/// point; empty: nothing. The arrays last as long as the caller's scope of the arena.
template <class RayScene>
void colour_scene(Arena& arena, const RenderOptions& options, std::span<const float> values, RayScene& scene) {
  const auto linear = [](const std::array<float, 3>& c) { return to_linear({c[0], c[1], c[2]}); };
  if (!values.empty()) {
    Array<float> scalar = arena.temporary<float>(values.size());
    scalar.upload(values);
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

/// Sets camera, light and size of a picture. `dims` is the extent of the domain in cells.
template <class Pixel>
void place_camera(const RenderOptions& options, const FlowDomain& domain, const Vec3d& dims, Pixel& pixel) {
  const Camera& camera = options.camera;
  GridCamera& view = pixel.camera;
  const Vec3d right = camera.right(), up = cross(right, camera.forward());
  const double half = 0.5 * camera.height / domain.cell_size;
  view.eye = domain.to_grid(camera.eye);
  view.forward = camera.forward();
  view.right = right * (half * options.width / options.height);
  view.up = up * half;
  view.distance = length(camera.target - camera.eye) / domain.cell_size, view.orthographic = camera.orthographic;
  pixel.scene.light = Vec3f(normalized(-view.forward + right * 0.35 + up * 0.55));
  // A ball around the target that holds the domain, and what the camera sees of it.
  pixel.reach = length(dims) + length(domain.to_grid(camera.target) - dims * 0.5) + half * 2;
  pixel.width = options.width;
  pixel.height = options.height;
  pixel.samples = std::max(1, options.samples);
}

}  // namespace nacre
