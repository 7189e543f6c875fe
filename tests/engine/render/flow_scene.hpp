// Nacre: a small flow with a texture, for tests of what is drawn.
#pragma once

#include <memory>

#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/interop/shared_buffer.hpp"
#include "engine/render/surface_pass.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/surface/flow_input.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "tests/compute/pipeline/choose_embedding.hpp"

namespace nacre::test {

/// A built-in sample with some steps of texture, the shown values in OpenGL's memory.
struct FlowScene {
  PreparedSurface surface;
  std::unique_ptr<Device> device = make_cpu_device();
  std::unique_ptr<FlowPipeline> pipeline = make_flow_pipeline(*device);
  std::unique_ptr<SharedBuffer> shown;  ///< values, and means behind them
  TextureLayout layout;

  explicit FlowScene(const std::string& sample, int detail, int resolution, int refine = 4,
                     const std::string& embedding = "grid") {
    surface = prepare(make_sample(sample, detail).load(0));
    choose_embedding(pipeline->parameters, embedding);
    pipeline->parameters.resolution = resolution;
    pipeline->parameters.refine = refine;
    pipeline->embed(flow_mesh(surface));
    FlowVectors vectors;
    vectors.at = [this](double t, std::span<Vec3f> out) {
      const std::vector<Vec3f> field = analytic_vectors("@swirl", surface, t);
      std::copy(field.begin(), field.end(), out.begin());
    };
    pipeline->flow().start(vectors);
    const FlowLookup l = pipeline->flow().lookup();
    layout.values = l.means > 0 ? std::int64_t(l.values) : -1;
    shown = std::make_unique<SharedBuffer>(*device, (l.values + l.means) * sizeof(float), GL_R32F);
    step();
  }

  void step() {
    auto* const memory = static_cast<float*>(shown->begin_write(true));
    pipeline->flow().show_into(memory, layout.values >= 0 ? memory + layout.values : nullptr);
    pipeline->flow().step();
    shown->end_write();
  }

  SurfaceTexture texture(std::size_t page = 0) const {
    const FlowLookup l = pipeline->flow().lookup();
    if (l.kind != FlowLookup::Kind::grid)
      return OctreeTexture({l.levels, l.origin, l.cell_size, l.node, l.level_start, l.layer, l.child}, page);
    const SparseLookup lookup{l.bricks, l.subcells, l.refine, l.origin, l.cell_size, l.brick_index, l.block, l.texel};
    return SparseTexture(lookup, with_rims(lookup), page);
  }

  SurfaceGeometry geometry() const {
    return make_surface_geometry(surface.points, surface.triangles, surface.corner_normals);
  }
};

}  // namespace nacre::test
