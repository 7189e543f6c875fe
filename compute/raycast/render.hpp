// Nacre: one pixel of a picture of the flow: value times colour map, with light (design card, "picture").
#pragma once

#include "compute/raycast/cast.hpp"

namespace nacre {

/// A camera in cells of the closest-point grid, with its axes scaled so that (x, y) in -1..1 spans the picture.
struct GridCamera {
  Vec3d eye, forward, right, up;  ///< forward: unit; right, up: half the visible extent at the target
  double distance = 1;            ///< from the eye to the target
  bool orthographic = false;

  /// The ray through (x, y), begun at most `reach` cells in front of the target, so that single precision will do.
  NACRE_HD Ray ray(double x, double y, double reach) const {
    const Vec3d across = right * x + up * y;
    const Vec3d direction = orthographic ? forward : normalized(forward * distance + across);
    const Vec3d origin = orthographic ? eye + across : eye;
    const double skip = distance - reach > 0 ? distance - reach : 0;
    return {Vec3f(origin + direction * skip), Vec3f(direction)};
  }
};

/// What is drawn and how.
struct Scene {
  ClosestPointGridView grid;
  RefinedGridView texture;
  MeshView mesh;
  const float* shown = nullptr;     ///< per surface cell, 0..1; null: plain surface
  const float* scalar = nullptr;    ///< per point of the mesh, to colour by; null: gray
  const Float4* colours = nullptr;  ///< 256 entries, linear light
  float low = 0, high = 1;          ///< range of the scalar over the colour map
  Vec3f light{};                    ///< unit, towards the light
  float ambient = 0.3f;
  Vec3f background{};  ///< linear light
  float background_alpha = 1;
};

NACRE_HD inline Vec3f to_linear(const Vec3f& c) { return {c.x * c.x, c.y * c.y, c.z * c.z}; }  // gamma 2, near sRGB

/// Colour of a point of the surface, linear light.
NACRE_HD inline Vec3f shade(const Scene& scene, const Ray& ray, const Hit& hit) {
  Vec3f base(0.62f, 0.62f, 0.62f);
  if (scene.scalar) {
    const Triangle t = scene.mesh.triangles[hit.triangle];
    const float s =
        scene.scalar[t.a] * hit.weights.x + scene.scalar[t.b] * hit.weights.y + scene.scalar[t.c] * hit.weights.z;
    const float x = (s - scene.low) / (scene.high - scene.low);
    const float at = (x > 0 ? x < 1 ? x : 1 : 0) * 255.0f;
    const int k = at < 254 ? int(at) : 254;
    const Float4 a = scene.colours[k], b = scene.colours[k + 1];
    const float f = at - float(k);
    base = {a.x + (b.x - a.x) * f, a.y + (b.y - a.y) * f, a.z + (b.z - a.z) * f};
  }
  const Vec3f n = scene.mesh.normal(hit.triangle, hit.weights);
  const float facing = dot(n, ray.direction) > 0 ? -1.0f : 1.0f;  // surfaces have two sides
  const float diffuse = dot(n, scene.light) * facing;
  float brightness = scene.ambient + (1 - scene.ambient) * (diffuse > 0 ? diffuse : 0);
  if (scene.shown) {
    const Vec3f p = (ray.origin + ray.direction * hit.t) * float(scene.texture.refine);
    const float value = sample(scene.texture, scene.shown, p, 0.5f);
    brightness *= 0.25f + 1.15f * value;
  }
  return base * brightness;
}

/// Renders pixel i of width x height: `samples`^2 rays, averaged in linear light; RGBA, 8 bits a channel.
struct RenderPixel {
  Scene scene;
  GridCamera camera;
  int width, height, samples;
  double reach;  ///< radius of a ball around the target that holds the surface
  std::uint32_t* pixels;

  NACRE_HD void operator()(std::int64_t i) const {
    const int px = int(i % width), py = int(i / width);
    Vec3f sum{};
    float alpha = 0;
    for (int k = 0; k < samples * samples; ++k) {
      const double x = (px + (k % samples + 0.5) / samples) / width * 2 - 1;
      const double y = 1 - (py + (k / samples + 0.5) / samples) / height * 2;
      const Ray ray = camera.ray(x, y, reach);
      Hit hit;
      const bool seen = cast(scene.grid, scene.mesh, ray, hit);
      sum += seen ? shade(scene, ray, hit) : scene.background;
      alpha += seen ? 1.0f : scene.background_alpha;
    }
    const float n = 1.0f / float(samples * samples);
    pixels[i] = channel(std::sqrt(sum.x * n)) | channel(std::sqrt(sum.y * n)) << 8 |
                channel(std::sqrt(sum.z * n)) << 16 | channel(alpha * n) << 24;
  }

  NACRE_HD static std::uint32_t channel(float v) { return std::uint32_t((v < 0 ? 0 : v > 1 ? 1 : v) * 255.0f + 0.5f); }
};

}  // namespace nacre
