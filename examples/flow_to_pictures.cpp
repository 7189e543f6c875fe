// Nacre: unsteady flow on a torus becomes a picture per step. Usage: flow_to_pictures PREFIX
#include <cmath>
#include <cstdio>
#include <nacre/flow.hpp>

int main(int argc, char** argv) try {
  if (argc != 2) return std::fputs("usage: flow_to_pictures PREFIX\n", stderr), 2;
  nacre::SurfaceFlow torus;
  constexpr unsigned n = 60, m = 30;
  for (unsigned i = 0; i < n * m; ++i) {
    const double u = 2 * M_PI * (i / m) / n, v = 2 * M_PI * (i % m) / m, r = 2 + 0.8 * std::cos(v);
    torus.points.push_back({r * std::cos(u), r * std::sin(u), 0.8 * std::sin(v)});
    const unsigned right = (i + m) % (n * m), up = i % m + 1 < m ? i + 1 : i + 1 - m;
    const unsigned both = right % m + 1 < m ? right + 1 : right + 1 - m;
    torus.triangles.push_back({i, right, both});
    torus.triangles.push_back({i, both, up});
  }
  torus.times = {0, 1, 2};
  torus.vectors = [&](std::size_t step, std::span<float> out) {  // around the axis, and ever more along it
    for (std::size_t i = 0; i < torus.points.size(); ++i)
      out[3 * i] = float(-torus.points[i][1]), out[3 * i + 1] = float(torus.points[i][0]), out[3 * i + 2] = 0.5f * step;
  };
  nacre::Flow flow(torus, {{"steps", 4}, {"resolution", 192}, {"width", 320}, {"height", 240}});
  while (flow.step()) nacre::save(argv[1] + std::to_string(flow.frame()) + ".png", flow.picture());
  std::printf("%d pictures, time %g\n", flow.frame(), flow.time());
} catch (const nacre::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
