// Nacre: runs of the flow pipeline on built-in surfaces.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/picture/image.hpp"
#include "engine/scene/settings/settings.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Which embedding, how fine.
struct FlowJob {
  std::string sample;
  int detail = 0;  ///< of the sample; 0: its own
  EmbeddingKind method = EmbeddingKind::grid;
  OctreeKind octree = OctreeKind::brick;
  bool neighbour_index = false;
  int resolution = 1024, refine = 4;
  double radius = 0;

  bool operator<(const FlowJob& o) const {
    return std::tie(sample, detail, method, octree, neighbour_index, resolution, refine, radius) <
           std::tie(o.sample, o.detail, o.method, o.octree, o.neighbour_index, o.resolution, o.refine, o.radius);
  }
};

/// `detail` of the samples with --small: building costs time per triangle, too.
inline constexpr int small_flow_detail = 200;

struct FlowRun {
  EmbeddingInfo embedding;
  double embed = 0, refine = 0;  ///< seconds
  double step = 0;               ///< seconds of a step, ttl 2: the median of a few
  std::size_t arena_bytes = 0;
};

class FlowRuns {
 public:
  explicit FlowRuns(Device& device) : device_(device) {}

  int repeats = 1;                      ///< of short embeddings; the fastest counts
  std::function<void(Settings&)> turn;  ///< the user's knobs; a job overrides them

  /// Bytes that the run will need, and those that there are.
  double estimate(const FlowJob& job);
  double available() const { return double(device_.arena_bytes()); }
  /// The finest resolution whose estimate fits what there is; the estimates alone decide, and the range of the keys.
  int largest_resolution(FlowJob job);

  /// Triangles of the sample.
  std::size_t triangles(const FlowJob& job);

  /// Every run has a pipeline of its own, whose memory is given back at its end. Throws Error and Interrupted.
  const FlowRun& run(const FlowJob& job);
  /// Seconds to embed the surface and take one step, with everything in memory that is kept (`times` runs in one
  /// pipeline, the first not counted) or allocated again for each; the fastest.
  double embed_and_step(const FlowJob& job, bool again, int times);
  /// A picture after some steps, coloured by speed.
  Image picture(const FlowJob& job, int steps, int width, int height);

 private:
  FlowParameters turned() const;
  FlowParameters parameters(const FlowJob& job) const;
  VectorsInTime& sample(const FlowJob& job);
  FlowMesh mesh(const FlowJob& job);
  FlowVectors vectors(const FlowJob& job);
  std::unique_ptr<FlowPipeline> pipeline(const FlowJob& job) const;

  Device& device_;
  std::string sample_name_;
  int sample_detail_ = 0;
  std::unique_ptr<VectorsInTime> sample_;
  std::map<FlowJob, FlowRun> runs_;
};

}  // namespace nacre
