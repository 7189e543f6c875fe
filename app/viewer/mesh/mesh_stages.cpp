// Nacre: the mesh pipeline on a thread of its own: what its stages do.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "app/viewer/mesh/mesh_worker.hpp"
#include "compute/device/error.hpp"
#include "compute/meshing/tetrahedra.hpp"
#include "engine/io/mesh_writer.hpp"
#include "engine/run/mesh_result.hpp"
#include "engine/scene/volume/materials.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

constexpr int slice_pixels = 512;         ///< along the longer side of a slice of a field
constexpr std::size_t most_worst = 1000;  ///< triangles that can be outlined as the worst

bool has_cells(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  const std::vector<std::string> known = tetrahedral_mesh_extensions();
  return std::find(known.begin(), known.end(), extension) != known.end();
}

}  // namespace

void MeshWorker::read() {
  note_progress({"read", 0, 0, 0, 0});
  StageTimers::Scope scope(pipeline_->timers(), "read");
  MaterialSettings materials;
  {
    std::scoped_lock lock(mutex_);
    materials = wanted_.materials;
  }
  volumes_ = std::make_shared<std::vector<Volume>>(read_mesh_volumes(input_, materials, &interrupt_));
}

void MeshWorker::choose_materials() {
  note_progress({"materials", 0, 0, 0, 0});
  MaterialSettings materials;
  {
    std::scoped_lock lock(mutex_);
    materials = wanted_.materials;
  }
  auto viewed = std::make_shared<ViewedVolume>();
  MeshVolume volume;
  {
    StageTimers::Scope scope(pipeline_->timers(), "classify");
    volume = materials_of(materials, viewed->input);
    volume.sizes = read_size_image(materials);
    if (volume.kind == MeshVolume::Kind::scalar) viewed->spread = spread_of(volumes_->front());
  }
  pipeline_->load(volume);
  viewed->volumes = volumes_;
  viewed->material = std::move(volume.material.own());
  viewed_ = std::move(viewed);
  made_mesh_.volume = viewed_;
  made_mesh_.corners = viewed_->corners();
  made_mesh_.frame = pipeline_->voxel_frame();
  tell(VolumeRead{viewed_, made_mesh_.corners, made_mesh_.frame});
  if (live_) preview();
}

void MeshWorker::preview() {
  {
    std::scoped_lock lock(mutex_);
    if (!wanted_.view.preview) return;
  }
  note_progress({"preview", -1, 0, 0, 0});
  PreviewMade told;
  {
    StageTimers::Scope scope(pipeline_->timers(), "preview");
    told.preview = make_mesh_preview(*viewed_, &interrupt_);
  }
  tell(std::move(told));
}

/// A live view shows something first, and the user moves the iso-value then; a replay needs it given.
MeshVolume MeshWorker::materials_of(MaterialSettings materials, MeshInput& input) {
  const bool sample = !input_.sample.empty();
  std::string proposal;
  try {
    return make_materials(*volumes_, sample, materials, input);
  } catch (const MissingIsovalue& missing) {
    std::scoped_lock lock(mutex_);
    if (lockstep_) throw;
    proposal = fmt::format("{:.4g}", missing.proposal());
    wanted_.materials.isovalue = materials.isovalue = proposal;
  }
  MeshVolume volume = make_materials(*volumes_, sample, materials, input);
  input.warnings.push_back(fmt::format(
      "{} is no label map: it was cut at the iso-value {}, which the tab 'data' changes", input.name, proposal));
  tell(IsovalueProposed{proposal});
  return volume;
}

void MeshWorker::build_fields() { pipeline_->build_fields(); }

void MeshWorker::relax() {
  RelaxBegun told{pipeline_->info(), 0, 0, 0};
  told.capacity = told.box_capacity = pipeline_->particle_capacity();
  {
    std::scoped_lock lock(mutex_);
    lent_.reset();
    made_ = 0;
    told.lease = ++lease_;
  }
  tell(told);
  pipeline_->relax();
}

void MeshWorker::triangulate() {
  auto mesh = std::make_shared<SurfaceMesh>(pipeline_->triangulate());
  MeshTriangulated told{mesh, make_mesh_drawing(*mesh), TriangleTree(mesh->points, mesh->triangles), pipeline_->info()};
  if (!await_turn()) throw Interrupted();
  mesh_ = std::move(mesh);
  made_mesh_.mesh = mesh_;
  made_mesh_.info = told.info;
  MeshProgress last;
  {
    std::scoped_lock lock(mutex_);
    last = progress_;
  }
  last.particles = told.info.final;
  show(last, false);
  tell(std::move(told));
}

void MeshWorker::measure() {
  note_progress({"quality", 0.95, 0, 0, 0});
  auto measures = std::make_shared<MeshMeasures>();
  {
    StageTimers::Scope scope(pipeline_->timers(), "quality");
    measures->topology = check_topology(*mesh_, int(viewed_->input.labels.size()));
    measures->quality = surface_quality(*mesh_);
    measures->area = material_areas(*mesh_, viewed_->input.labels.size());
    measures->worst = worst_triangles(*mesh_, most_worst);
  }
  if (interrupt_) throw Interrupted();
  measures->distance = pipeline_->surface_distance(*mesh_);
  measures->size = pipeline_->field_at(MeshField::size, mesh_->points);
  for (float& size : measures->size) size /= float(viewed_->voxel_length());
  made_mesh_.measures = measures;
  tell(MeshMeasured{std::move(measures)});
}

/// The mesh of an earlier time, with what is drawn of it made again. The pipeline stays as it is.
void MeshWorker::bring_back() {
  std::shared_ptr<const KeptMesh> kept;
  {
    std::scoped_lock lock(mutex_);
    kept = std::exchange(back_, nullptr);
    if (!kept) return;
    unshown_ = false;
  }
  if (viewed_ != kept->volume) tell(VolumeRead{kept->volume, kept->corners, kept->frame});
  viewed_ = kept->volume;
  mesh_ = kept->mesh;
  tell(MeshTriangulated{mesh_, make_mesh_drawing(*mesh_), TriangleTree(mesh_->points, mesh_->triangles), kept->info,
                        true});
  tell(MeshMeasured{kept->measures});
}

void MeshWorker::fill_slice() {
  SliceRequest request;
  {
    std::scoped_lock lock(mutex_);
    if (!slice_due()) return;
    request = *slice_;
  }
  SliceFilled told;
  told.number = request.number;
  told.field = request.field;
  told.plane = request.plane;
  const double width = length(told.plane.across), height = length(told.plane.up), longer = std::max(width, height);
  told.columns = std::max(1, int(slice_pixels * width / longer));
  told.rows = std::max(1, int(slice_pixels * height / longer));
  const std::vector<Vec3d> positions = told.plane.positions(told.columns, told.rows);
  told.values = pipeline_->field_at(request.field, positions);
  for (std::size_t i = 0; told.plane.is_oblique() && i < positions.size(); ++i)
    if (!viewed_->index_at(positions[i])) told.values[i] = std::numeric_limits<float>::quiet_NaN();
  {
    std::scoped_lock lock(mutex_);
    if (slice_ && slice_->number == request.number) slice_filled_ = true;
    events_.push_back(std::move(told));
  }
  told_.notify_all();
}

void MeshWorker::write_result() {
  ResultFile wanted;
  bool complete, curved, fields;
  double max_cell;
  {
    std::scoped_lock lock(mutex_);
    wanted = *std::exchange(file_, std::nullopt);
    complete = next_ == MeshStage::done;
    max_cell = wanted_.max_cell;
    curved = wanted_.element_order == 2;
    fields = fields_;
    progress_ = {"write", -1, 0, 0, 0};
    writing_ = true;
  }
  MeshWritten told{complete ? "it was cancelled" : "there is no mesh yet; wait until it is made"};
  const auto write = [&] {
    const MeshInput& input = viewed_->input;
    const std::filesystem::path& file = wanted.file;
    if (curved) check_second_order(file, has_cells(file));
    if (curved && !fields)
      throw Error("an earlier mesh has no interfaces to put nodes on", "the fields are those of other knobs",
                  "make it again, or set `element_order` to 1");
    std::optional<TetrahedralMesh> cells;
    if (has_cells(file)) {
      StageTimers::Scope scope(pipeline_->timers(), "tetrahedra");
      cells = fill_with_tetrahedra(*mesh_, longest_edge(max_cell, input.spacing), &interrupt_);
    }
    std::optional<SecondOrder> nodes;
    if (curved) nodes = mesh_nodes(*mesh_, cells ? &*cells : nullptr, *pipeline_, &interrupt_);
    const SecondOrder* second = nodes ? &*nodes : nullptr;
    StageTimers::Scope scope(pipeline_->timers(), "write");
    if (cells)
      write_tetrahedral_mesh(file, *cells, *mesh_, input.labels, input.names, wanted.origin, second);
    else
      write_surface_mesh(file, *mesh_, input.labels, input.names, wanted.origin, second);
    told.failure.clear();
  };
  if (complete)
    if (const std::optional<std::string> failure = failure_of(write)) told.failure = *failure;
  {
    std::scoped_lock lock(mutex_);
    all_turns_ = writing_ = false;
  }
  tell(std::move(told));
}

}  // namespace nacre
