// Nacre: a solver of one's own on the tetrahedra of a volume: heat in two materials, linear finite elements.
// A shell is kept at temperature 0, and a core in it is heated. Usage: heat_in_labels
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <nacre/mesh.hpp>

namespace {

using Vec = std::array<double, 3>;

Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::vector<std::uint8_t> two_balls() {
  std::vector<std::uint8_t> labels(32 * 32 * 32);
  for (int i = 0; i < 32 * 32 * 32; ++i) {
    const double x = i % 32 - 15.5, y = i / 32 % 32 - 15.5, z = i / 1024 - 15.5, r = std::sqrt(x * x + y * y + z * z);
    labels[i] = r < 6 ? 2 : r < 12 ? 1 : 0;
  }
  return labels;
}

/// Stiffness matrix and load, row by row.
struct System {
  std::vector<std::map<std::uint32_t, double>> matrix;
  std::vector<double> load;
  std::vector<bool> fixed;
};

System assemble(const nacre::Mesh& mesh, const nacre::Tetrahedra& cells, double conductivity[3], double heating[3]) {
  System s{std::vector<std::map<std::uint32_t, double>>(cells.points.size()), std::vector<double>(cells.points.size()),
           std::vector<bool>(cells.points.size())};
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const auto& corner = cells.cells[c];
    const Vec &a = cells.points[corner[0]], ab = minus(cells.points[corner[1]], a),
              ac = minus(cells.points[corner[2]], a), ad = minus(cells.points[corner[3]], a);
    const double volume = dot(ab, cross(ac, ad)) / 6;
    const std::int64_t label = mesh.materials[cells.material[c]].label;
    std::array<Vec, 4> gradient{Vec{}, cross(ac, ad), cross(ad, ab), cross(ab, ac)};
    for (int k = 1; k < 4; ++k)
      for (int x = 0; x < 3; ++x) gradient[k][x] /= 6 * volume, gradient[0][x] -= gradient[k][x];
    for (int i = 0; i < 4; ++i) {
      s.load[corner[i]] += heating[label] * volume / 4;
      for (int j = 0; j < 4; ++j)
        s.matrix[corner[i]][corner[j]] += conductivity[label] * volume * dot(gradient[i], gradient[j]);
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.sides[t][0] == 0)  // the outside is on one side
      for (const std::uint32_t corner : mesh.triangles[t]) s.fixed[corner] = true;
  return s;
}

/// Conjugate gradients with the diagonal as preconditioner.
std::vector<double> solve(const System& s) {
  const std::size_t n = s.load.size();
  std::vector<double> x(n), r(n), d(n), q(n);
  double rho = 0, first = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (!s.fixed[i]) r[i] = s.load[i], d[i] = r[i] / s.matrix[i].at(i), rho += r[i] * d[i];
  first = rho;
  for (int step = 0; step < 2000 && rho > 1e-20 * first; ++step) {
    double curvature = 0, next = 0;
    for (std::size_t i = 0; i < n; ++i) {
      q[i] = 0;
      if (s.fixed[i]) continue;
      for (const auto& [j, value] : s.matrix[i]) q[i] += value * d[j];
      curvature += d[i] * q[i];
    }
    for (std::size_t i = 0; i < n; ++i)
      if (!s.fixed[i]) {
        x[i] += rho / curvature * d[i], r[i] -= rho / curvature * q[i];
        next += r[i] * r[i] / s.matrix[i].at(i);
      }
    for (std::size_t i = 0; i < n; ++i)
      if (!s.fixed[i]) d[i] = r[i] / s.matrix[i].at(i) + next / rho * d[i];
    rho = next;
  }
  return x;
}

}  // namespace

int main() try {
  const std::vector<std::uint8_t> labels = two_balls();
  nacre::Meshing run(nacre::volume_view<std::uint8_t>(labels, {32, 32, 32}), {{"max_size", 1.5}});
  double conductivity[] = {0, 1, 5}, heating[] = {0, 0, 1};
  const std::vector<double> heat = solve(assemble(run.mesh(), run.tetrahedra(), conductivity, heating));
  // Balls of the volumes that the cells have. In the core q r^2 / 6 k2 below the middle, in the shell q a^3 / 3 k1 r.
  double volume[3] = {};
  for (std::size_t c = 0; c < run.tetrahedra().cells.size(); ++c) {
    const auto& corner = run.tetrahedra().cells[c];
    const auto& p = run.tetrahedra().points;
    const Vec ab = minus(p[corner[1]], p[corner[0]]), ac = minus(p[corner[2]], p[corner[0]]);
    const double part = dot(ab, cross(ac, minus(p[corner[3]], p[corner[0]]))) / 6;
    volume[run.mesh().materials[run.tetrahedra().material[c]].label] += part;
  }
  const double a = std::cbrt(0.75 / M_PI * volume[2]), b = std::cbrt(0.75 / M_PI * (volume[1] + volume[2]));
  const double exact = a * a / (6 * conductivity[2]) + a * a * a / 3 * (1 / a - 1 / b) / conductivity[1];
  const double found = *std::max_element(heat.begin(), heat.end());
  std::printf("%zu cells; radii %.3f and %.3f; warmest %.3f, exact %.3f\n", run.tetrahedra().cells.size(), a, b, found,
              exact);
  return std::abs(found - exact) < 0.02 * exact ? 0 : 1;
} catch (const nacre::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
