// Nacre: built-in sample on an airliner: free stream, tip vortices, and separation on the wing in travelling cells.
#include <numbers>

#include "engine/scene/samples/implicit_shapes.hpp"
#include "engine/scene/samples/polygonise.hpp"
#include "engine/scene/samples/sample_kit.hpp"

namespace nacre {
namespace {

using std::numbers::pi;
constexpr double aircraft_length = 3.84;  // along x from -1.92 (nose); the wings along y, z up; symmetric in y
constexpr double wing_half_span = 1.91;
constexpr double engine_span = 0.66, engine_height = -0.275;

/// A tapered, swept wing panel in its own frame: `x` along the chord, `span` outward from the root, `off` across.
struct Panel {
  double root_leading, leading_slope;    // x of the leading edge = root_leading + leading_slope * span
  double root_trailing, trailing_slope;  // likewise, but the trailing edge never lies before `kink`
  double kink;
  double half_span;
  double thickness;  // of the chord, half

  double leading(double span) const { return root_leading + leading_slope * span; }
  double trailing(double span) const { return -smooth_union(-(root_trailing + trailing_slope * span), -kink, 0.12); }

  double operator()(double x, double span, double off) const {
    const double at = std::clamp(span, -0.1, half_span);
    const double start = leading(at), chord = trailing(at) - start;
    // Not thinner at the trailing edge than what the default detail resolves.
    const double nose = std::max(0.45 * thickness * chord, 0.011), belly = std::max(thickness * chord, 0.016),
                 tail = 0.0095;
    const double thickest = 0.36 * chord;
    const double front = round_cone(x - start - nose, off, thickest - nose, nose, belly);
    const double rear = round_cone(x - start - thickest, off, chord - thickest - tail, belly, tail);
    return rounded_extrusion(std::min(front, rear), span, half_span, 0.0095);
  }
};

constexpr Panel wing_panel{-0.52, 0.60, 0.02, 0.44, 0.38, wing_half_span, 0.058};
constexpr Panel tailplane_panel{1.27, 0.62, 1.66, 0.32, -9, 0.70, 0.05};
constexpr Panel fin_panel{1.13, 0.80, 1.68, 0.26, -9, 0.66, 0.055};

double wing_height(double span) { return -0.11 + 0.09 * span; }

/// Half an ellipsoid for the nose, a cylinder, and half a longer ellipsoid, bent upwards, for the tail.
double fuselage(const Vec3d& p) {
  constexpr double body_radius = 0.22, nose_at = -1.25, tail_at = 0.55;  // the cylinder lies between the last two
  constexpr double nose_length = 0.67, tail_length = 1.37;
  const double beyond = p.x < nose_at ? p.x - nose_at : std::max(p.x - tail_at, 0.0);
  const double stretch = beyond < 0 ? nose_length / body_radius : tail_length / body_radius;
  const double bend = (beyond < 0 ? -0.10 : 0.075) * beyond * beyond;
  const Vec3d q{beyond / stretch, p.y, p.z - bend};  // the point where the ellipsoid is a sphere
  const double radius = length(q), slope = length(Vec3d{q.x / stretch, q.y, q.z});
  // Deep inside, this first-order distance is too large; a constant will do there.
  return std::max((radius - body_radius) * radius / std::max(slope, 1e-9), -0.1);
}

/// An open duct under the wing, and the pylon that holds it.
double nacelle(double x, double span, double z) {
  constexpr double body_radius = 0.108;
  const double from_axis = norm(span - engine_span, z - engine_height);
  const double duct = round_cone(x + 0.60, from_axis - body_radius, 0.46, 0.022, 0.011);
  const double sweep = 1.1 * (z - engine_height - body_radius);
  const double blade = round_cone(x + 0.42 - sweep, span - engine_span, 0.46, 0.02, 0.012) * 0.8;
  const double pylon = rounded_extrusion(blade, z - (engine_height + body_radius + 0.06), 0.075, 0.01);
  return smooth_union(duct, pylon, 0.03);
}

/// Signed distance (about) to the aircraft.
double aircraft(const Vec3d& p) {
  const double span = std::abs(p.y);
  const double body = fuselage(p);
  const double wing = wing_panel(p.x, span, p.z - wing_height(span));
  const double tailplane = tailplane_panel(p.x, span, p.z - 0.10 - 0.10 * span);
  const double fin = std::max(fin_panel(p.x, p.z - 0.10, p.y), 0.08 - p.z);  // its root ends within the body
  double all = smooth_union(body, wing, 0.12);
  all = smooth_union(all, smooth_union(tailplane, fin, 0.03), 0.06);
  return smooth_union(all, nacelle(p.x, span, p.z), 0.03);
}

SampleShape aircraft_shape(int detail) {
  PolygonMesh mesh = polygonise(aircraft, {-2.1, -2.0, -0.6}, {2.1, 2.0, 1.0}, aircraft_length / detail);
  return {std::move(mesh.points), std::move(mesh.normals), std::move(mesh.triangles)};
}

/// Cells on the wing that drift towards the tips along the line of separation, and streets along the fuselage.
std::vector<Eddy> aircraft_eddies(double time) {
  std::vector<Eddy> eddies;
  for (const double side : {-1.0, 1.0}) {
    constexpr double spacing = 0.36;
    for (int i = -1; i < 5; ++i) {
      const auto cell = [&](double span, double chordwise, double radius, double spin, double spread) {
        const double fade = smooth_step(0.27, 0.55, span) * (1 - smooth_step(1.6, 1.85, span));
        const double x = wing_panel.leading(span) + chordwise * (wing_panel.trailing(span) - wing_panel.leading(span));
        const double size = radius * (wing_panel.trailing(span) - wing_panel.leading(span));
        eddies.push_back({{x, side * span, wing_height(span)}, size, side * spin * fade, spread * fade});
      };
      const double span = 0.25 + spacing * (i + time);
      cell(span, 0.70, 0.22, -1.5, -0.3);
      cell(span + 0.5 * spacing, 0.45, 0.20, 1.2, 0.25);
    }
    for (int i = -1; i < 6; ++i) {
      const double x = -1.7 + 0.62 * (i + time + (side < 0 ? 0.5 : 0.0));
      const double fade = smooth_step(-1.5, -0.9, x) * (1 - smooth_step(1.1, 1.7, x));
      eddies.push_back({{x, side * 0.13, 0.18}, 0.13, side * 0.75 * fade, -0.45 * fade});
      eddies.push_back({{x + 0.31, side * 0.21, 0.02}, 0.10, -side * 0.7 * fade, 0.2 * fade});
    }
  }
  return eddies;
}

/// Rotation about the line along x through the wing tip, which is where the vortex leaves it.
Vec3d tip_vortex(const Vec3d& p, double side, double strength) {
  const Vec3d arm{0, p.y - side * (wing_half_span - 0.1), p.z - wing_height(wing_half_span) - 0.03};
  const double core = 0.14;
  return cross(Vec3d{-side, 0, 0}, arm) *
         (strength * core / (dot(arm, arm) + core * core) * smooth_step(0.4, 0.9, p.x));
}

/// 1 on the fuselage, 0 on the wings.
double on_body(const Vec3d& p) { return 1 - smooth_step(0.2, 0.3, std::abs(p.y)); }

/// Flow around the fuselage, stronger further aft: attached along the belly and the back, separating in between, along
/// lines on either side that swing with the wind.
Vec3d body_crossflow(const Vec3d& p, const Vec3d& n, double phase) {
  const double angle = std::atan2(p.z, p.y);
  const double turn = std::cos(angle) * (0.75 - std::sin(angle)) + 0.25 * std::sin(phase);
  return cross(Vec3d{1, 0, 0}, n) * (0.5 * on_body(p) * smooth_step(-1.9, 0.5, p.x) * turn);
}

/// Slow outboard drift over the rear of the wing, where the flow is about to separate, and waves on its lower side.
Vec3d wing_drift(const Vec3d& p, const Vec3d& n, double phase) {
  const double span = std::abs(p.y), side = p.y < 0 ? -1 : 1;
  const double chordwise = (p.x - wing_panel.leading(span)) / (wing_panel.trailing(span) - wing_panel.leading(span));
  const double over = smooth_step(-0.2, 0.4, n.z) * smooth_step(0.35, 0.9, chordwise);
  const double under = smooth_step(-0.2, 0.4, -n.z);
  const Vec3d drift = Vec3d{-0.55, 0.75 * side, 0} * (over * (0.75 + 0.4 * std::sin(9 * span - phase)));
  const Vec3d waves = Vec3d{0.2, -0.5 * side, 0} * (under * std::sin(7 * p.x + 6 * span + phase));
  return (drift + waves) * (1 - on_body(p));
}

/// Swirl around the nacelles, and a flutter of the flow over the fin.
Vec3d engine_and_fin(const Vec3d& p, double phase) {
  const double side = p.y < 0 ? -1 : 1;
  const Vec3d arm{0, p.y - side * engine_span, p.z - engine_height};
  const double engine = (1 - smooth_step(0.13, 0.19, length(arm))) * (1 - smooth_step(-0.05, 0.1, p.x));
  const double flutter = 0.55 * smooth_step(0.2, 0.4, p.z) * std::sin(9 * p.z - 5 * p.x + phase);
  return cross(Vec3d{side, 0, 0}, arm) * (engine * (3 + 4 * std::sin(14 * p.x - phase))) + Vec3d{0, 0, flutter};
}

SampleField aircraft_flow(double time) {
  const double phase = 2 * pi * time;
  const Vec3d wind{1, 0.16 * std::sin(phase), 0.12};
  return [phase, wind, eddies = aircraft_eddies(time)](const Vec3d& p, const Vec3d& n) {
    const double shed = std::max(on_body(p), smooth_step(-0.2, 0.4, n.z));  // not below the wings
    return wind + body_crossflow(p, n, phase) + wing_drift(p, n, phase) + engine_and_fin(p, phase) +
           tip_vortex(p, p.y < 0 ? -1 : 1, 1.3) + sum_of(eddies, p, n) * shed;
  };
}

}  // namespace

SampleDefinition aircraft_sample() {
  return {{"aircraft", "airliner with wing, tail and nacelles: attachment, separation on the wing, tip vortices"},
          300,
          200,
          24,
          aircraft_shape,
          aircraft_flow};
}

}  // namespace nacre
