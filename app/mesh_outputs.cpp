// Nacre: the files that `nacre mesh` writes.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "app/mesh_run.hpp"
#include "app/picture_options.hpp"
#include "compute/raycast/mesh_picture.hpp"
#include "engine/io/mesh_writer.hpp"
#include "engine/io/vtp_writer.hpp"
#include "engine/picture/legend.hpp"
#include "engine/picture/material_colours.hpp"
#include "engine/picture/png.hpp"
#include "engine/run/material_palette.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

bool has(const std::vector<std::string>& list, const std::string& one) {
  return std::find(list.begin(), list.end(), one) != list.end();
}

void write_particles(const std::string& file, const MeshParticles& particles, const std::string& origin) {
  const std::size_t n = particles.points.size();
  std::vector<PointArray> arrays{{"size", 1, particles.size},
                                 {"energy", 1, particles.energy},
                                 {"order", 1, std::vector<float>(particles.order.begin(), particles.order.end())},
                                 {"normal", 3, std::vector<float>(3 * n)}};
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) arrays[3].values[3 * i + k] = particles.normal[i][k];
  write_vtp(file, std::span<const Vec3d>(particles.points), {}, arrays, std::nullopt, {}, xml_origin(origin));
}

Image draw_mesh(const SurfaceMesh& mesh, const MeshInput& input, const Session& session, bool cut_away) {
  const Settings& settings = session.settings;
  MeshPictureOptions options;
  options.camera = read_camera(session, mesh.points, false);
  options.width = settings.width;
  options.height = settings.height;
  options.samples = settings.samples;
  options.transparent = settings.background == "transparent";
  if (!options.transparent) options.background = parse_color(settings.background);
  Vec3d low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const Vec3d& p : mesh.points) low = min(low, p), high = max(high, p);
  const Vec3d middle = (low + high) * 0.5, forward = options.camera.forward();
  std::vector<Triangle> triangles;
  std::vector<Color> colours;
  const std::vector<Color> palette = material_palette(input, settings.view.material_colors);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const Vec3d centre = (mesh.points[triangle.a] + mesh.points[triangle.b] + mesh.points[triangle.c]) / 3.0;
    if (cut_away && dot(centre - middle, forward) < 0) continue;
    triangles.push_back(triangle);
    colours.push_back(pair_colour(mesh.materials[t], palette));
  }
  Image image;
  image.width = settings.width;
  image.height = settings.height;
  image.pixels = mesh_picture(mesh.points, triangles, colours, options);
  if (settings.legend)
    draw_orientation(image, Vec3f(options.camera.right()), Vec3f(cross(options.camera.right(), forward)),
                     Vec3f(forward));
  return image;
}

}  // namespace

bool wants_cells(const MeshOptions& options) {
  return has(tetrahedral_mesh_extensions(), lower_extension(options.out)) && !options.surface_only &&
         !options.per_material;
}

void check_mesh_outputs(const MeshOptions& options) {
  if (!options.out.empty()) {
    const std::string extension = lower_extension(options.out);
    if (!has(mesh_extensions(), extension))
      throw UsageError(fmt::format("cannot write {}; use one of {}", options.out, fmt::join(mesh_extensions(), " ")));
    if ((options.per_material || options.surface_only) && !has(surface_mesh_extensions(), extension))
      throw UsageError(fmt::format("{} writes surfaces; use one of {}",
                                   options.per_material ? "--per-material" : "--surface-only",
                                   fmt::join(surface_mesh_extensions(), " ")));
  } else if (options.per_material || options.surface_only) {
    throw UsageError(options.per_material ? "--per-material needs --out FILE" : "--surface-only needs --out FILE");
  }
  check_output(options.out, "--out", "");
  check_output(options.particles_out, "--particles-out", ".vtp");
  check_output(options.image, "--image", ".png");
  check_output(options.common.report, "--report", "");
  check_output(options.common.save_session, "--save-session", "");
}

std::vector<std::string> write_mesh_outputs(const MeshOptions& options, const Session& session, const MeshInput& input,
                                            const MeshResult& result, const MeshPipeline& pipeline, StageTimers& timers,
                                            const Origin& origin) {
  const std::string out_origin = origin_of_output(origin, "out");
  std::vector<std::string> files;
  Image image;
  if (!options.image.empty()) {
    StageTimers::Scope scope(timers, "render");
    image = draw_mesh(result.mesh, input, session, options.cut_away);
  }
  StageTimers::Scope scope(timers, "write");
  const SecondOrder* second = result.second ? &*result.second : nullptr;
  if (result.cells) {
    write_tetrahedral_mesh(options.out, *result.cells, result.mesh, input.labels, input.names, out_origin, second);
    files.push_back(options.out);
  } else if (options.per_material) {
    for (const fs::path& file :
         write_material_surfaces(options.out, result.mesh, input.labels, input.names, out_origin, second))
      files.push_back(file.string());
  } else if (!options.out.empty()) {
    write_surface_mesh(options.out, result.mesh, input.labels, input.names, out_origin, second);
    files.push_back(options.out);
  }
  if (!options.particles_out.empty()) {
    write_particles(options.particles_out, pipeline.particles(), origin_of_output(origin, "particles-out"));
    files.push_back(options.particles_out);
  }
  if (!options.image.empty()) {
    write_png(options.image, image, origin_of_output(origin, "image"));
    files.push_back(options.image);
  }
  return files;
}

}  // namespace nacre
