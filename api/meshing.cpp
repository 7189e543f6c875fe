// Nacre: a mesh run of the library, stage by stage.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "api/arrays_read.hpp"
#include "api/meshes.hpp"
#include "api/support.hpp"
#include "compute/pipeline/mesh_rerun.hpp"
#include "engine/run/mesh_result.hpp"
#include "engine/run/presets.hpp"
#include "engine/run/report.hpp"
#include "include/nacre/mesh.hpp"

namespace nacre {
namespace {

template <class T>
std::vector<T> copied(const VolumeView& view, std::size_t n) {
  std::vector<T> values(n);
  std::memcpy(values.data(), view.values, n * sizeof(T));
  return values;
}

VolumeValues values_of(const VolumeView& view, std::size_t n) {
  switch (view.type) {
    case VoxelType::uint8: return copied<std::uint8_t>(view, n);
    case VoxelType::int8: return copied<std::int8_t>(view, n);
    case VoxelType::uint16: return copied<std::uint16_t>(view, n);
    case VoxelType::int16: return copied<std::int16_t>(view, n);
    case VoxelType::uint32: return copied<std::uint32_t>(view, n);
    case VoxelType::int32: return copied<std::int32_t>(view, n);
    case VoxelType::uint64: return copied<std::uint64_t>(view, n);
    case VoxelType::int64: return copied<std::int64_t>(view, n);
    case VoxelType::float32: return copied<float>(view, n);
    case VoxelType::float64: return copied<double>(view, n);
  }
  throw Error("unknown type of voxels");
}

void check_axes(const VolumeView& view) {
  for (int a = 0; a < 3; ++a) {
    if (!(view.spacing[a] > 0) || !std::isfinite(view.spacing[a]))
      throw Error(fmt::format("the spacing of {} is {:g}", view.name, view.spacing[a]), "", "it must be above 0");
    if (!std::isfinite(view.origin[a])) throw Error(fmt::format("the origin of {} is not finite", view.name));
    for (int b = 0; b <= a; ++b) {
      double product = 0;
      for (int k = 0; k < 3; ++k) product += view.axes[a][k] * view.axes[b][k];
      if (!(std::abs(product - (a == b ? 1 : 0)) < 1e-4))
        throw Error(fmt::format("the axes of {} are not orthogonal unit vectors", view.name),
                    "sheared volumes cannot be meshed", "resample the volume onto a grid with right angles");
    }
  }
}

Volume volume_of(const VolumeView& view) {
  constexpr std::int64_t most = 1 << 20;
  Volume volume;
  volume.name = view.name;
  for (int a = 0; a < 3; ++a)
    if (view.size[a] < 2 || view.size[a] > most)
      throw Error(fmt::format("{} has {} x {} x {} voxels", view.name, view.size[0], view.size[1], view.size[2]), "",
                  "it needs at least 2 along every axis");
  if (!view.values) throw Error(fmt::format("{} has no values", view.name));
  check_axes(view);
  volume.dims = {int(view.size[0]), int(view.size[1]), int(view.size[2])};
  volume.spacing = {view.spacing[0], view.spacing[1], view.spacing[2]};
  volume.origin = {view.origin[0], view.origin[1], view.origin[2]};
  for (int a = 0; a < 3; ++a) volume.axes[std::size_t(a)] = {view.axes[a][0], view.axes[a][1], view.axes[a][2]};
  volume.values = values_of(view, volume.voxels());
  volume.label_names = view.names;
  return volume;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

struct Meshing::State {
  RunOptions options;
  Session session;
  std::unique_ptr<Device> device;
  std::unique_ptr<MeshPipeline> pipeline;
  MeshInput input;
  MeshVolume volume;  ///< its voxels' materials, which the mesh is compared with; no values
  ArraysRead arrays;
  MeshResult result;
  MeshParameters used;  ///< those that the stages up to `stage` were computed with
  double used_max_cell = 0;
  int used_order = 1, mesh_order = 1;  ///< `element_order` of `tetrahedra` and of `mesh`
  Stage stage = Stage::materials;
  bool remarked = false, measured = false, filled = false;
  double seconds = 0;
  mutable std::mutex mutex;

  Mesh mesh;
  Tetrahedra tetrahedra;
  MeshQuality quality;

  Settings& settings() { return session.settings; }

  void show_progress() {
    pipeline->progress = [this](const MeshProgress& p) {
      if (options.progress) options.progress({std::string(p.stage), p.fraction, p.iteration, p.particles, p.energy});
    };
  }

  void announce(const char* name, double fraction) {
    check_stop(options.stop);
    if (options.progress) options.progress({name, fraction, 0, 0, 0});
  }

  void load(std::span<const VolumeView> views) {
    std::vector<Volume> volumes;
    for (std::size_t k = 0; k < views.size(); ++k) {
      volumes.push_back(volume_of(views[k]));
      std::visit([&](const auto& voxels) { arrays.add("volume", k, voxels.data(), voxels.size() * sizeof(voxels[0])); },
                 volumes.back().values);
    }
    if (volumes.empty()) throw Error("no volume is given");
    const auto warn = [this](const std::string& sentence) { tell(options, sentence); };
    volume = make_materials(volumes, false, settings().materials, input, warn);
    volumes.clear();
    pipeline->load(volume);
    volume.values = {};
  }

  void build_fields() {
    pipeline->build_fields();
    const FieldRemarks said = remarks_on_fields(pipeline->info(), settings().mesh);
    for (const std::string& sentence : said.warnings) tell(options, sentence);
    if (!remarked)
      for (const std::string& sentence : said.remarks) tell(options, sentence);
    remarked = true;
  }

  void triangulate() {
    result = {};
    result.mesh = pipeline->triangulate();
    measured = filled = false;
  }

  /// Only facets of Delaunay cells can be filled: a mesh of stars is triangulated anew, from the same particles.
  void require_facets() {
    finish();
    const StarUse& stars = pipeline->info().stars;
    if (stars.meshes + stars.fallbacks == 0) return;
    if (settings().mesh.triangles == "stars")
      throw Error("tetrahedra need `triangulation` to be auto or delaunay", "it is stars", "leave it so");
    const double started = seconds_now();
    stage = Stage::particles;  // should it be interrupted
    pipeline->parameters.triangles = "delaunay";
    triangulate();
    stage = Stage::triangles;
    publish(mesh_order);
    seconds += seconds_now() - started;
  }

  /// The mesh as the library gives it.
  void publish(int order) {
    std::optional<SecondOrder> second;
    if (order == 2) second = mesh_nodes(result.mesh, nullptr, *pipeline, options.stop);
    mesh = public_mesh(result.mesh, second ? &*second : nullptr, input);
    mesh.origin = library_origin(session, "mesh", device->backend(), arrays, "out");
    mesh_order = order;
  }

  bool advance() {
    if (stage == Stage::triangles) return false;
    check_stop(options.stop);
    check_particle_sizes(settings().mesh);
    const double started = seconds_now();
    pipeline->parameters = settings().mesh;
    used = settings().mesh;
    switch (stage) {
      case Stage::materials: build_fields(); break;
      case Stage::fields: pipeline->relax(); break;
      default: triangulate(); break;
    }
    stage = Stage(int(stage) + 1);
    seconds += seconds_now() - started;
    if (stage == Stage::triangles) publish(settings().element_order);
    return true;
  }

  void finish() {
    while (advance()) {
    }
  }

  void measure() {
    finish();
    if (measured) return;
    const double started = seconds_now();
    announce("quality", 0.95);
    measure_triangles(result, int(input.labels.size()), pipeline->timers());
    result.distance = pipeline->surface_distance(result.mesh);
    quality.radius_ratio_mean = result.quality.all.radius_ratio_mean;
    quality.radius_ratio_min = result.quality.all.radius_ratio_min;
    quality.angle_min = result.quality.all.angle_min;
    quality.angle_max = result.quality.all.angle_max;
    quality.distance_mean = result.distance.facet_mean;
    quality.distance_max = result.distance.facet_max;
    quality.sound = result.topology.sound();
    quality.lost_labels = lost_labels(input.labels, result.topology);
    quality.flaws.clear();
    for (const std::string& flaw : mesh_flaws(input.labels, result.topology))
      quality.flaws.push_back(with_knob_names(flaw));
    measured = true;
    seconds += seconds_now() - started;
  }

  void fill() {
    require_facets();
    measure();
    const int order = settings().element_order;
    if (filled && used_max_cell == settings().max_cell && used_order == order) return;
    const double started = seconds_now();
    if (!filled || used_max_cell != settings().max_cell) {
      announce("tetrahedra", 0.97);
      result.second.reset();
      fill_result(result, settings().max_cell, input, pipeline->timers(), options.stop);
    }
    bend();
    tetrahedra = public_tetrahedra(*result.cells, result.second ? &*result.second : nullptr);
    used_max_cell = settings().max_cell;
    used_order = order;
    filled = true;
    seconds += seconds_now() - started;
  }

  /// The nodes of the result, or none, as the knob asks for.
  void bend() {
    if (settings().element_order == 1) return result.second.reset();
    if (result.second) return;
    announce("nodes", 0.98);
    add_second_order(result, *pipeline, input, options.stop);
  }
};

Meshing::Meshing(std::span<const VolumeView> volumes, const KnobValues& knobs, RunOptions options,
                 const std::string& preset)
    : state_(std::make_unique<State>()) {
  library_call([&] {
    State& s = *state_;
    s.options = std::move(options);
    if (s.options.processes)
      throw Error("a mesh cannot be made by several processes", "RunOptions::processes is set", "leave it null");
    if (!preset.empty() && preset != "source") throw Error("no preset '" + preset + "'", "", "use source");
    if (preset == "source") apply_thesis_preset(s.settings());
    apply_knobs(s.settings(), knobs, Job::mesh);
    if (preset == "source" && !knobs.contains("kernel"))
      apply_thesis_kernel(s.settings(), is_cut_at_isovalues(s.session));
    check_particle_sizes(s.settings().mesh);
    s.device = open_library_device(s.options);
    const Caller caller(s.mutex, s.options.threads);
    s.pipeline = make_mesh_pipeline(*s.device);
    s.pipeline->watch(s.options.stop);
    s.pipeline->parameters = s.used = s.settings().mesh;
    s.show_progress();
    const double started = seconds_now();
    s.load(volumes);
    s.seconds = seconds_now() - started;
  });
}

Meshing::Meshing(const VolumeView& volume, const KnobValues& knobs, RunOptions options, const std::string& preset)
    : Meshing(std::span(&volume, 1), knobs, std::move(options), preset) {}

Meshing::~Meshing() = default;
Meshing::Meshing(Meshing&&) noexcept = default;
Meshing& Meshing::operator=(Meshing&&) noexcept = default;

Meshing::Stage Meshing::stage() const { return state_->stage; }

bool Meshing::advance() {
  return library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    return state_->advance();
  });
}

void Meshing::set(const std::string& knob, const KnobValue& value) {
  library_call([&] {
    State& s = *state_;
    const Caller caller(s.mutex, 0);
    Settings changed = s.settings();
    apply_knobs(changed, {{knob, value}}, Job::mesh);
    for (const KnobDescription& each : describe_knobs(Job::mesh))
      if (each.name == knob && !each.live)
        throw Error(fmt::format("{} cannot be changed any more", knob), "the materials are chosen when a run begins",
                    "begin a new run");
    s.settings() = changed;
    const auto reached = [&](Stage most) { s.stage = std::min(s.stage, most); };
    switch (mesh_rerun(s.used, changed.mesh)) {
      case MeshRerun::nothing: break;
      case MeshRerun::triangulate: reached(Stage::particles); break;
      case MeshRerun::relax: reached(Stage::fields); break;
      case MeshRerun::fields: reached(Stage::materials); break;
    }
  });
}

KnobValue Meshing::get(const std::string& knob) const {
  return library_call([&] { return knob_value(state_->session.settings, knob, Job::mesh); });
}

Particles Meshing::particles() const {
  return library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    if (state_->stage < Stage::particles)
      throw Error("there are no particles yet", "", "advance to the stage of particles first");
    return public_particles(state_->pipeline->particles());
  });
}

const Mesh& Meshing::mesh() {
  return *library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    state_->finish();
    if (state_->mesh_order != state_->settings().element_order) state_->publish(state_->settings().element_order);
    return &state_->mesh;
  });
}

const MeshQuality& Meshing::quality() {
  return *library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    state_->measure();
    return &state_->quality;
  });
}

const Tetrahedra& Meshing::tetrahedra() {
  return *library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    state_->fill();
    return &state_->tetrahedra;
  });
}

std::string Meshing::report() const {
  return library_call([&] {
    State& s = *state_;
    const Caller caller(s.mutex, s.options.threads);
    s.measure();
    s.bend();
    if (s.result.voxels.empty()) compare_with_voxels(s.result, s.volume, s.pipeline->timers(), s.options.stop);
    nlohmann::json report = report_frame("mesh", *s.device, s.pipeline->timers(), s.pipeline->peak_bytes());
    add_mesh_report(report, s.input, s.settings(), s.pipeline->info(), s.result);
    report["seconds"] = s.seconds;
    return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  });
}

}  // namespace nacre
