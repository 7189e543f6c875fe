// Nacre: one pixel of a picture of the flow: texture value times colour map, with light.
#pragma once

#include "compute/embedding/refined_grid.hpp"
#include "compute/flow/sample_band.hpp"
#include "compute/raycast/cast.hpp"
#include "compute/raycast/footprint.hpp"
#include "compute/raycast/octree_cast.hpp"
#include "compute/raycast/sheets.hpp"

namespace nacre {

/// A camera in cells of the closest-point grid, with its axes scaled so that (x, y) in -1..1 spans the picture.
struct GridCamera {
  Vec3d eye, forward, right, up;  ///< forward: unit; right, up: half the visible extent at the target
  double distance = 1;            ///< from the eye to the target
  bool orthographic = false;

  /// The ray through (x, y). It begins at most `reach` cells in front of the target, so that single precision is
  /// sufficient if the grid is small.
  NACRE_HD Ray ray(double x, double y, double reach) const {
    const Vec3d across = right * x + up * y;
    const Vec3d direction = orthographic ? forward : normalized(forward * distance + across);
    const Vec3d origin = orthographic ? eye + across : eye;
    const double skip = distance - reach > 0 ? distance - reach : 0;
    return {origin + direction * skip, direction};
  }
};

/// What is drawn and how, whatever the rays traverse.
struct Shading {
  MeshView mesh{};
  const float* shown = nullptr;     ///< per surface cell, 0..1; null: plain surface
  const float* scalar = nullptr;    ///< per point of the mesh, to colour by; null: gray
  const Float4* colours = nullptr;  ///< 256 entries, linear light
  float low = 0, high = 1;          ///< range of the scalar over the colour map
  Vec3f below{}, above{};           ///< of values beyond that range, linear light
  Vec3f no_number{};                ///< of NaN
  Vec3f light{};                    ///< unit, towards the light
  float ambient = 0.3f;
  bool neutral_backs = false;  ///< faces that look away are grey
  bool hidden_backs = false;   ///< ... or not there
  Vec3f background{};          ///< linear light
  float background_alpha = 1;
};

/// What a ray sees: all that is needed to shade it, for a process that may not have the triangle.
struct SeenSample {
  double t = 1e300;
  std::uint32_t triangle = none;  ///< its number among those of all processes; none: nothing is seen
  float value = 0;                ///< of the texture
  float scalar = 0;               ///< to colour by
  Vec3f normal{};
  std::uint32_t away = 0;  ///< 1: the face looks away
};

// What rays traverse. A target has find(mesh, ray, hit), which returns whether the ray meets the surface, and
// texture(shown, ray, hit, footprint), the shown value at a hit. `at` of the targets below gives it at a position of
// the embedded surface, in cells. `nearest` holds the tree of triangles, where there is one, and the sheets.

/// The two-level grid with its refined grid.
struct GridTarget {
  ClosestPointGridView grid;
  RefinedGridView texels;
  NearestTriangles nearest{};
  const float* means = nullptr;  ///< of the shown values in each block

  NACRE_HD bool find(const MeshView& mesh, const Ray& ray, Hit& hit) const {
    return nearest.boxes ? nearest.find(mesh, ray, hit) : cast(grid, mesh, ray, hit);
  }

  NACRE_HD float texture(const float* shown, const Ray& ray, const Hit& hit, const Footprint& footprint) const {
    return at(shown, nearest.sheets.point(ray, hit), footprint);
  }

  NACRE_HD float at(const float* shown, const Vec3d& point, const Footprint& footprint) const {
    const auto refine = float(texels.refine);
    const Vec3f p = Vec3f(point) * refine;
    const auto fine = [&](const Vec3f& off) { return sample(texels, shown, p + off, no_value); };
    const auto coarse = [&](const Vec3f& off) { return sample_means(texels, means, Vec3f(point) + off / refine); };
    return filtered(footprint * refine, refine, fine, coarse);
  }
};

/// A band: either octree. That of the thesis has no means.
template <class View>
struct BandTarget {
  View view;
  NearestTriangles nearest{};
  const float* means = nullptr;                   ///< of the shown values in each brick
  std::uint32_t own_first = 0, own_count = none;  ///< bricks that this process has to show

  NACRE_HD bool find(const MeshView& mesh, const Ray& ray, Hit& hit) const {
    return nearest.boxes ? nearest.find(mesh, ray, hit) : cast(view, mesh, ray, hit);
  }

  NACRE_HD float texture(const float* shown, const Ray& ray, const Hit& hit, const Footprint& footprint) const {
    return at(shown, nearest.sheets.point(ray, hit), footprint);
  }

  NACRE_HD float at(const float* shown, const Vec3d& point, const Footprint& footprint) const {
    const BandPoint p = band_point(point);
    const auto fine = [&](const Vec3f& off) { return sample_band(view, shown, p + off, no_value); };
    const auto coarse = [&](const Vec3f& off) { return sample_brick_means(view, means, p + off); };
    return filtered(footprint, means ? brick_means_width : 0.0f, fine, coarse);
  }
};

/// Whether a hit is in what this process has to show: always, unless it shares an octree with others.
template <class Target>
NACRE_HD_INLINE bool is_own(const Target&, const Ray&, const Hit&) {
  return true;
}
NACRE_HD_INLINE bool is_own(const BandTarget<BrickOctreeView>& target, const Ray& ray, const Hit& hit) {
  BrickOctreeView::Cursor cursor(target.view);
  const std::uint32_t brick = cursor.brick_of(band_point(target.nearest.sheets.point(ray, hit)).base);
  return brick - target.own_first < target.own_count;
}

template <class Target>
struct RayScene : Shading {
  Target target;
};

NACRE_HD inline Vec3f to_linear(const Vec3f& c) { return {c.x * c.x, c.y * c.y, c.z * c.z}; }  // gamma 2, near sRGB

/// Colour of a scalar in linear light.
NACRE_HD inline Vec3f colour_of(const Shading& shading, float scalar) {
  const float x = (scalar - shading.low) / (shading.high - shading.low);
  constexpr float beyond = 1e-5f;  // rounding does not lead out of the range
  if (!(x >= 0) && !(x < 0)) return shading.no_number;
  if (x < -beyond) return shading.below;
  if (x > 1 + beyond) return shading.above;
  const float at = (x > 0 ? x < 1 ? x : 1 : 0) * 255.0f;
  const int k = at < 254 ? int(at) : 254;
  const Float4 a = shading.colours[k], b = shading.colours[k + 1];
  const float f = at - float(k);
  return {a.x + (b.x - a.x) * f, a.y + (b.y - a.y) * f, a.z + (b.z - a.z) * f};
}

/// What a hit shows; `value` is that of the texture, if there is one.
NACRE_HD inline SeenSample seen_at(const Shading& shading, const Ray& ray, const Hit& hit, float value) {
  SeenSample sample{hit.t, hit.triangle, value};
  sample.normal = shading.mesh.normal(hit.triangle, hit.weights);
  sample.away = shading.neutral_backs && faces_away(shading.mesh, hit.triangle, ray) ? 1 : 0;
  if (shading.scalar && !sample.away) {
    const Triangle t = shading.mesh.triangles[hit.triangle];
    sample.scalar =
        shading.scalar[t.a] * hit.weights.x + shading.scalar[t.b] * hit.weights.y + shading.scalar[t.c] * hit.weights.z;
  }
  return sample;
}

/// Colour of a point of the surface in linear light.
NACRE_HD inline Vec3f shade(const Shading& shading, const Ray& ray, const SeenSample& sample) {
  Vec3f base(0.62f, 0.62f, 0.62f);
  const float facing = dot(sample.normal, Vec3f(ray.direction)) > 0 ? -1.0f : 1.0f;  // surfaces have two sides
  if (shading.scalar && !sample.away) base = colour_of(shading, sample.scalar);
  const float diffuse = dot(sample.normal, shading.light) * facing;
  float brightness = shading.ambient + (1 - shading.ambient) * (diffuse > 0 ? diffuse : 0);
  if (shading.shown && !sample.away) brightness *= 0.04f + 1.52f * sample.value;
  return base * brightness;
}

/// Renders pixel i of width x height: `samples`^2 rays, averaged in linear light; RGBA, 8 bits a channel.
template <class Target>
struct RenderPixel {
  RayScene<Target> scene;
  GridCamera camera;
  int width, height, samples;
  double reach;  ///< radius of a ball around the target that contains the surface
  std::uint32_t* pixels;
  // Among several processes, each finds what there is to see of its own, and one shades what is nearest.
  std::int64_t first = 0;                 ///< pixel of index 0
  SeenSample* seen = nullptr;             ///< samples^2 entries for each index; null: nothing is recorded
  const SeenSample* given = nullptr;      ///< null: rays are cast
  const std::uint32_t* number = nullptr;  ///< of each triangle among those of all processes; null: as here
  float most = 0;                         ///< cells around a hit in which this process knows the values
  std::uint32_t* too_wide = nullptr;      ///< set where a footprint goes farther

  NACRE_HD void operator()(std::int64_t index) const {
    const std::int64_t i = first + index;
    const int px = int(i % width), py = int(i / width);
    const Shading& shading = scene;
    Vec3f sum{};
    float alpha = 0;
    for (int k = 0; k < samples * samples; ++k) {
      const double x = (px + (k % samples + 0.5) / samples) / width * 2 - 1;
      const int row = k / samples;
      const double y = 1 - (py + (row + 0.5) / samples) / height * 2;
      Ray ray = camera.ray(x, y, reach);
      ray.fronts_only = shading.hidden_backs;
      SeenSample sample;
      if (given) {
        sample = given[index * (samples * samples) + k];
      } else {
        Hit hit;
        if (scene.target.find(shading.mesh, ray, hit) && (!seen || is_own(scene.target, ray, hit))) {
          const Footprint f = footprint(ray, hit);
          const float value = shading.shown ? scene.target.texture(shading.shown, ray, hit, f) : 0;
          sample = seen_at(shading, ray, hit, value);
          if (seen && shading.shown && !(length(f.across) + length(f.up) <= 2 * most)) relaxed_store(too_wide, 1);
          if (number) sample.triangle = number[hit.triangle];
        }
        if (seen) {
          seen[index * (samples * samples) + k] = sample;
          continue;
        }
      }
      if (sample.triangle == none) {
        sum += shading.background;
        alpha += shading.background_alpha;
        continue;
      }
      sum += shade(shading, ray, sample);
      alpha += 1;
    }
    if (seen) return;
    const float n = 1.0f / float(samples * samples);
    pixels[i] = channel(std::sqrt(sum.x * n)) | channel(std::sqrt(sum.y * n)) << 8 |
                channel(std::sqrt(sum.z * n)) << 16 | channel(alpha * n) << 24;
  }

  /// What the hit of a ray stands for on the surface, in cells: what lies between it and the rays beside it.
  NACRE_HD Footprint footprint(const Ray& ray, const Hit& hit) const {
    const double depth = dot(ray.at(hit.t) - camera.eye, camera.forward);
    const double scale = camera.orthographic || camera.distance == 0 ? 1 : depth / camera.distance;
    const Vec3f across(camera.right * (2 * scale / (double(width) * samples)));
    const Vec3f up(camera.up * (2 * scale / (double(height) * samples)));
    const Vec3f along(ray.direction);
    return Footprint{across, up}.on_surface(along, scene.mesh.normal(hit.triangle, hit.weights));
  }

  NACRE_HD static std::uint32_t channel(float v) { return std::uint32_t((v < 0 ? 0 : v > 1 ? 1 : v) * 255.0f + 0.5f); }
};

}  // namespace nacre
