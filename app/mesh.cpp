// Nacre: `nacre mesh`: from a volume to a conformal mesh.
#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/mesh_run.hpp"
#include "app/picture_options.hpp"
#include "compute/device/error.hpp"
#include "engine/io/mesh_writer.hpp"
#include "engine/io/named_files.hpp"
#include "engine/run/presets.hpp"
#include "engine/run/report.hpp"
#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "engine/scene/volume/material_options.hpp"

namespace nacre {

namespace {

Session make_session(const MeshOptions& options, const KnobOptions& knobs) {
  const auto preset = [&](Settings& settings) {
    if (options.preset == "source") apply_thesis_preset(settings);
  };
  Session session = requested_session(options.common, options.input, knobs, "mesh", preset);
  if (options.preset == "source" && !knobs.given("kernel", options.common.set))
    apply_thesis_kernel(session.settings, is_cut_at_isovalues(session));
  return session;
}

void check_options(const MeshOptions& options, const Session& session) {
  const Settings& settings = session.settings;
  with_usage_errors([&] {
    if (!session.sample.empty() && !is_phantom(session.sample)) make_phantom(session.sample);  // throws the list
    parse_material_settings(settings.materials);
  });
  with_usage_errors([&] { check_particle_sizes(settings.mesh); });
  check_picture_options(settings);
  check_picture_size(settings.width, settings.height, !options.image.empty(), false);
  check_mesh_outputs(options);
  if (settings.element_order == 2 && !options.out.empty())
    with_usage_errors([&] { check_second_order(options.out, wants_cells(options)); });
  if (wants_cells(options) && settings.mesh.triangles == "stars")
    throw UsageError("tetrahedra need `triangulation` to be auto or delaunay; leave it so, or write a surface");
}

/// Reads the volumes and makes materials of them; `input` receives what the report contains about it.
MeshVolume read_input(const MeshOptions& options, const Session& session, StageTimers& timers, MeshInput& input) {
  StageTimers::Scope scope(timers, "read");
  const auto say_warning = [&](const std::string& warning) { warn(options.common, warning); };
  const auto read = [&] {
    return read_mesh_volumes(session, session.settings.materials, &interrupt_flag(), say_warning, true);
  };
  const bool sample = !session.sample.empty();
  const std::vector<Volume> volumes = sample ? with_usage_errors(read) : read();
  if (interrupt_flag()) throw Interrupted();
  MeshVolume volume = make_materials(volumes, sample, session.settings.materials, input, say_warning);
  volume.sizes = read_size_image(session.settings.materials);
  return volume;
}

void show_progress(MeshPipeline& pipeline, Progress& bar) {
  pipeline.progress = [&bar](const MeshProgress& p) {
    std::string what(p.stage);
    if (p.iteration > 0) what += fmt::format(" {}, {} particles", p.iteration, p.particles);
    if (p.energy > 0) what += fmt::format(", energy {:.4f}", p.energy);
    bar.update(what, p.fraction);
  };
}

/// Throws Interrupted after Ctrl-C, unless the mesh so far is to be kept.
void check_interrupt(bool kept) {
  if (!kept && interrupt_flag()) throw Interrupted();
}

MeshResult compute(const MeshOptions& options, const Settings& settings, const MeshInput& input,
                   const MeshVolume& volume, const InputWatch& watch, MeshPipeline& pipeline, Progress& bar) {
  MeshResult result;
  if (wants_cells(options) && pipeline.parameters.triangles == "auto") pipeline.parameters.triangles = "delaunay";
  pipeline.load(volume);
  watch.check();  // large volumes are read here
  pipeline.build_fields();
  bar.clear();
  const FieldRemarks said = remarks_on_fields(pipeline.info(), settings.mesh);
  for (const std::string& sentence : said.warnings) warn(options.common, sentence);
  for (const std::string& sentence : said.remarks) say(options.common, sentence);
  try {
    pipeline.relax();
  } catch (const Interrupted&) {
    if (!options.keep_on_interrupt) throw;
    result.interrupted = true;
    bar.clear();
    say(options.common, "interrupted: making the mesh from the particles so far");
  }
  const bool kept = options.keep_on_interrupt;  // from here on a first Ctrl-C asks for what is being made anyway
  if (kept) pipeline.watch(nullptr);
  result.mesh = pipeline.triangulate();
  check_interrupt(kept);
  bar.update("quality", 0.95);
  measure_triangles(result, volume.materials(), pipeline.timers());
  result.distance = pipeline.surface_distance(result.mesh);
  check_interrupt(kept);
  if (!options.common.report.empty())
    compare_with_voxels(result, volume, pipeline.timers(), kept ? nullptr : &interrupt_flag());
  if (wants_cells(options)) {
    bar.update("tetrahedra", 0.97);
    fill_result(result, settings.max_cell, input, pipeline.timers(), kept ? nullptr : &interrupt_flag());
  }
  if (settings.element_order == 2) {
    bar.update("nodes", 0.98);
    add_second_order(result, pipeline, input, kept ? nullptr : &interrupt_flag());
  }
  return result;
}

/// How the run's results come about.
Origin mesh_origin(const MeshOptions& options, const Session& session, const std::string& backend) {
  std::vector<std::filesystem::path> named = named_files(session.inputs);
  if (const std::string& sizes = session.settings.materials.size_image; !sizes.empty())
    for (const std::filesystem::path& file : named_files({sizes})) named.push_back(file);
  Origin origin = origin_of(session, "mesh", backend, named);
  add_beside(origin, {{"out", options.out}, {"particles-out", options.particles_out}, {"image", options.image}});
  if (options.per_material) origin.options.push_back("--per-material");
  if (options.surface_only) origin.options.push_back("--surface-only");
  if (options.cut_away) origin.options.push_back("--cut-away");
  return origin;
}

void run_mesh(const MeshOptions& options, const KnobOptions& knob_options) {
  const double started = now();
  const Session session = make_session(options, knob_options);
  check_options(options, session);
  const std::unique_ptr<Device> device = open_device(options.common);
  const std::unique_ptr<MeshPipeline> pipeline = make_mesh_pipeline(*device);
  pipeline->watch(&interrupt_flag());
  Progress bar(options.common.quiet);
  bar.update("read", 0);
  MeshInput input;
  InputWatch watch(session.inputs);
  if (const std::string& sizes = session.settings.materials.size_image; !sizes.empty()) watch.add({sizes});
  const MeshVolume volume = read_input(options, session, pipeline->timers(), input);
  Origin origin = mesh_origin(options, session, device->backend());
  watch.check();
  if (!options.common.save_session.empty()) write_text(options.common.save_session, session_text(session));
  pipeline->parameters = session.settings.mesh;
  show_progress(*pipeline, bar);

  const MeshResult result = compute(options, session.settings, input, volume, watch, *pipeline, bar);
  origin.interrupted = result.interrupted;
  bar.update("write", 0.99);
  const std::vector<std::string> outputs =
      write_mesh_outputs(options, session, input, result, *pipeline, pipeline->timers(), origin);
  bar.clear();
  const double seconds = now() - started;
  if (!options.common.report.empty()) {
    nlohmann::json report = report_frame("mesh", *device, pipeline->timers(), pipeline->peak_bytes());
    add_mesh_report(report, input, session.settings, pipeline->info(), result);
    report["seconds"] = seconds;
    write_report(options.common, std::move(report), outputs, origin);
  }
  for (const std::string& flaw : mesh_flaws(input.labels, result.topology)) warn_of_result(flaw);
  say(options.common, mesh_summary(input, pipeline->info(), result, seconds));
  print_outputs(outputs);
  if (result.interrupted) throw Interrupted();
}

}  // namespace

void add_mesh_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("mesh", "conformal mesh of a volume: surfaces and tetrahedra");
  auto options = std::make_shared<MeshOptions>();
  add_input_options(*command, options->input, "a label or scalar volume, or one indicator volume per material",
                    "voxels along the sample's longest side (0: its own)");
  command->add_option("--preset", options->preset, "source: the constants of the thesis")
      ->check(CLI::IsMember({"source"}));
  command->add_option(
      "--out", options->out,
      "surface: .vtp .ply .stl .obj .off .glb; filled with tetrahedra: .vtu, and with the surface .msh .msh4 "
      "(Gmsh) .inp (Abaqus) .mesh (MFEM) .feb (FEBio) .foam (OpenFOAM) .xdmf");
  command->add_flag("--surface-only", options->surface_only,
                    "write only the triangles to a .msh, .msh4 or .inp file, no tetrahedra");
  command->add_flag("--per-material", options->per_material, "write one closed surface per material: NAME_LABEL.ext");
  command->add_option("--particles-out", options->particles_out, "write the particles as .vtp");
  command->add_option("--image", options->image, "write a picture of the triangles as PNG");
  command->add_flag("--cut-away", options->cut_away, "leave the half nearer to the camera out of the picture");
  command->add_flag("--keep-on-interrupt", options->keep_on_interrupt,
                    "on Ctrl-C, stop moving particles and make the mesh from those so far");
  add_common_options(*command, options->common);
  add_save_session(*command, options->common);
  auto knob_options = std::make_shared<KnobOptions>(*command, "mesh");
  command->callback(
      [&run, options, knob_options] { run = [options, knob_options] { run_mesh(*options, *knob_options); }; });
}

}  // namespace nacre
