// Nacre: built-in sample on a combustion chamber with pipes and valves: swirl with a precessing axis, and tumble.
#include <array>
#include <numbers>

#include "engine/scene/samples/implicit_shapes.hpp"
#include "engine/scene/samples/polygonise.hpp"
#include "engine/scene/samples/sample_kit.hpp"

namespace nacre {
namespace {

using std::numbers::pi;
constexpr double height =
    4.72;                       // of the whole; the axis of the cylinder is z, the piston at 0, the pipes leave along y
constexpr double bore = 0.72;   // radius
constexpr double head = 2.9;    // height of the cylinder
constexpr double reach = 1.11;  // the pipes end at +-reach

/// A pipe that rises from the head, bends by a right angle and leaves along y. There are two on either side.
struct Pipe {
  double side;  // +1 or -1 along y
  double radius;
  double bend_height, bend_radius;
  double stream;  // speed away from the chamber

  static constexpr double pipe_across = 0.315;  // |x| of the centre line
  static constexpr double start = 0.31;         // |y| of the rising part
};

constexpr std::array<Pipe, 2> both_pipes{{{+1, 0.22, 4.08, 0.42, -0.9}, {-1, 0.195, 3.30, 0.45, 1.1}}};

struct NearestOnPipe {
  double distance;  // from the centre line
  double out;       // along y, from the rising part
  Vec3d tangent;    // of the centre line, away from the chamber
  Vec3d away;       // from the centre line to the point
};

NearestOnPipe nearest_on(const Pipe& pipe, const Vec3d& p) {
  const double x = std::abs(p.x) - Pipe::pipe_across, sign = p.x < 0 ? -1 : 1;
  const double out = pipe.side * p.y - Pipe::start, up = p.z - pipe.bend_height, r = pipe.bend_radius;
  // From the centre of the bend; on it the line is a quarter circle, beyond its ends it is straight.
  const double u = out - r, v = up;
  double off_out = out, off_up = 0;
  Vec3d tangent{0, 0, 1};
  if (v > 0 && u < 0) {
    const double rho = std::max(norm(u, v), 1e-9);
    off_out = u - u * r / rho;
    off_up = v - v * r / rho;
    tangent = {0, pipe.side * v / rho, -u / rho};
  } else if (u >= 0 && std::abs(v - r) < std::abs(out)) {
    off_out = 0;
    off_up = v - r;
    tangent = {0, pipe.side, 0};
  }
  return {norm(x, norm(off_out, off_up)), out, tangent, {sign * x, pipe.side * off_out, off_up}};
}

double pipe_body(const Pipe& pipe, const Vec3d& p) {
  const double tube = nearest_on(pipe, p).distance - pipe.radius;
  const double ended = rounded_extrusion(tube, std::max(pipe.side * p.y, 0.0), reach, 0.03);
  return std::max(ended, head - 0.15 - p.z);
}

/// A poppet valve, opened into the chamber; its stem leaves through the pipe's bend.
double valve(const Pipe& pipe, const Vec3d& p) {
  const double lift = pipe.side > 0 ? 0.24 : 0.15;
  const double off = norm(std::abs(p.x) - Pipe::pipe_across, pipe.side * p.y - Pipe::start);
  const double z = p.z - (head - lift);
  const double stem = std::max(off - 0.045, -z);
  const double plate = rounded_extrusion(off - 0.93 * pipe.radius, z, 0.035, 0.03);
  return smooth_union(stem, plate, 0.16);
}

/// Signed distance (about) to the gas: cylinder and pipes, less the valves and the dome of the piston.
double chamber(const Vec3d& p) {
  double gas = rounded_extrusion(norm(p.x, p.y) - bore, p.z - head / 2, head / 2, 0.06);
  const double dome = length(p - Vec3d{0, 0, -1.22}) - 1.36;
  gas = smooth_cut(gas, dome, 0.06);
  for (const Pipe& pipe : both_pipes) gas = smooth_union(gas, pipe_body(pipe, p), 0.08);
  for (const Pipe& pipe : both_pipes) gas = smooth_cut(gas, valve(pipe, p), 0.08);
  return gas;
}

SampleShape cylinder_shape(int detail) {
  PolygonMesh mesh = polygonise(chamber, {-0.9, -1.3, -0.15}, {0.9, 1.3, 4.9}, height / detail);
  return {std::move(mesh.points), std::move(mesh.normals), std::move(mesh.triangles)};
}

/// Along the pipe, winding around it, faster and slower in turns.
Vec3d pipe_flow(const Vec3d& p, double phase) {
  const Pipe& pipe = both_pipes[p.y < 0];
  const NearestOnPipe near = nearest_on(pipe, p);
  const double along = p.z + std::abs(p.y);
  const Vec3d around = cross(near.tangent, near.away) / pipe.radius * (p.x < 0 ? -1.0 : 1.0);
  const double wave = 2.6 * along - std::copysign(phase, pipe.stream);
  return near.tangent * (pipe.stream * (0.8 + 0.35 * std::sin(wave))) + around * (0.35 + 0.75 * std::cos(wave));
}

/// Swirl whose axis circles about the cylinder's, tumble, and helical waves that travel up the wall.
Vec3d chamber_flow(const Vec3d& p, double phase) {
  const double angle = std::atan2(p.y, p.x), r = norm(p.x, p.y) / bore;
  const Vec3d axis{0.2 * std::cos(phase) * (1 - 0.5 * p.z / head), 0.2 * std::sin(phase) * (1 - 0.5 * p.z / head), 0};
  const Vec3d swirl = cross(Vec3d{0, 0, 1}, p - axis) / bore;
  const Vec3d tumble = cross(Vec3d{std::cos(0.4), std::sin(0.4), 0}, p - Vec3d{0, 0, head / 2}) / head;
  const double helix = 2 * angle - 5.0 * p.z + phase, counter = 3 * angle + 3.1 * p.z + phase;
  const Vec3d radial = Vec3d{p.x, p.y, 0} / bore;
  return swirl * (0.5 + 0.55 * std::sin(helix)) + tumble * (0.6 + 0.3 * std::cos(phase)) +
         Vec3d{0, 0, 1} * (r * (0.75 * std::cos(helix) + 0.45 * std::sin(counter))) +
         radial * (0.35 * std::cos(3 * angle - phase) - 0.15);
}

SampleField cylinder_flow(double time) {
  const double phase = 2 * pi * time;
  return [phase](const Vec3d& p, const Vec3d&) {
    const double in_pipe = smooth_step(head - 0.1, head + 0.35, p.z);
    Vec3d v;
    if (in_pipe < 1) v += chamber_flow(p, phase) * (1 - in_pipe);
    if (in_pipe > 0) v += pipe_flow(p, phase) * in_pipe;
    return v;
  };
}

}  // namespace

SampleDefinition cylinder_sample() {
  return {{"cylinder", "combustion chamber with two intake and two exhaust pipes and valves: swirl and tumble"},
          230,
          140,
          24,
          cylinder_shape,
          cylinder_flow};
}

}  // namespace nacre
