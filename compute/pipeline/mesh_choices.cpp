// Nacre: enums for the choices that MeshParameters holds as strings.
#include "compute/pipeline/mesh_choices.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {
namespace {

template <class Choice>
using Named = std::pair<std::string_view, Choice>;

constexpr std::array<Named<Solver>, 3> solvers{
    {{"tree", Solver::tree}, {"redblack", Solver::redblack}, {"serial", Solver::serial}}};
constexpr std::array<Named<CubicKernel>, 2> kernels{
    {{"catmull-rom", CubicKernel::catmull_rom}, {"b-spline", CubicKernel::b_spline}}};
constexpr std::array<Named<TriangleSource>, 3> triangle_sources{
    {{"auto", TriangleSource::automatic}, {"delaunay", TriangleSource::delaunay}, {"stars", TriangleSource::stars}}};
constexpr std::array<Named<QualityLevel>, 3> qualities{
    {{"draft", QualityLevel::draft}, {"standard", QualityLevel::standard}, {"best", QualityLevel::best}}};
constexpr std::array<Named<Projection>, 2> projections{
    {{"fields", Projection::fields}, {"embedding", Projection::embedding}}};
enum class Seeds { automatic, embedding, marching_cubes };
constexpr std::array<Named<Seeds>, 3> seed_names{
    {{"auto", Seeds::automatic}, {"embedding", Seeds::embedding}, {"marching-cubes", Seeds::marching_cubes}}};

template <class Choice>
Choice choice_of(std::span<const Named<Choice>> named, const std::string& parameter, std::string_view text) {
  std::string all;
  for (const auto& [name, choice] : named) {
    if (name == text) return choice;
    all += (all.empty() ? "" : ", ") + std::string(name);
  }
  throw Error("`" + parameter + "` cannot be '" + std::string(text) + "'", "", "choose one of " + all);
}

template <class Choice>
std::string name_of(std::span<const Named<Choice>> named, Choice choice) {
  return std::string(std::find_if(named.begin(), named.end(), [&](const Named<Choice>& each) {
                       return each.second == choice;
                     })->first);
}

}  // namespace

std::string to_string(Solver solver) { return name_of<Solver>(solvers, solver); }
std::string to_string(TriangleSource source) { return name_of<TriangleSource>(triangle_sources, source); }
std::string to_string(CubicKernel kernel) { return name_of<CubicKernel>(kernels, kernel); }

Solver solver_from_string(std::string_view text) { return choice_of<Solver>(solvers, "solver", text); }
CubicKernel kernel_from_string(std::string_view text) { return choice_of<CubicKernel>(kernels, "kernel", text); }
TriangleSource triangles_from_string(std::string_view text) {
  return choice_of<TriangleSource>(triangle_sources, "triangulation", text);
}
Projection projection_from_string(std::string_view text) {
  return choice_of<Projection>(projections, "projection", text);
}
QualityLevel quality_from_string(std::string_view text) { return choice_of<QualityLevel>(qualities, "quality", text); }

SeedOrigin seeds_from_string(std::string_view text, Solver solver) {
  switch (choice_of<Seeds>(seed_names, "seeds", text)) {
    case Seeds::embedding: return SeedOrigin::embedding;
    case Seeds::marching_cubes: return SeedOrigin::marching_cubes;
    default: return solver == Solver::tree ? SeedOrigin::embedding : SeedOrigin::marching_cubes;
  }
}

MeshParameters at_quality(const MeshParameters& parameters) {
  MeshParameters p = parameters;
  switch (quality_from_string(parameters.quality)) {
    case QualityLevel::draft:
      p.subcells = 1;
      p.projection = "fields";
      p.coarse_iterations = std::min(p.coarse_iterations, 16);
      p.iterations = std::min(p.iterations, 8);
      p.smooth = std::min(p.smooth, 1);
      p.remesh = std::min(p.remesh, 12);
      break;
    case QualityLevel::best:
      p.subcells = std::max(p.subcells, 2);
      p.iterations = std::max(p.iterations, 120);
      p.stagnation = std::min(p.stagnation, 0.0000125);
      p.smooth = std::max(p.smooth, 4);
      p.remesh = std::max(p.remesh, 40);
      break;
    case QualityLevel::standard: break;
  }
  if (triangles_from_string(p.triangles) == TriangleSource::automatic) p.triangles = to_string(TriangleSource::stars);
  return p;
}

MeshChoices::MeshChoices(const MeshParameters& parameters)
    : solver(solver_from_string(parameters.solver)),
      kernel(kernel_from_string(parameters.kernel)),
      seeds(seeds_from_string(parameters.seeds, solver)),
      triangles(triangles_from_string(parameters.triangles)),
      quality(quality_from_string(parameters.quality)) {}

}  // namespace nacre
