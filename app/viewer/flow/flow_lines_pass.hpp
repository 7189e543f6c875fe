// Nacre: draws lines and marks over a flow.
#pragma once

#include <memory>

#include "app/viewer/flow/flow_lines.hpp"
#include "engine/render/geometry.hpp"
#include "engine/render/mark_pass.hpp"
#include "engine/render/segment_pass.hpp"

namespace nacre {

/// What the knobs `topology` and `streamlines` show.
class FlowLinesPass {
 public:
  /// Null: none. Model coordinates are those of the surface.
  void set_lines(std::shared_ptr<const FlowLines> lines, const SurfaceBuffers& surface);
  const std::shared_ptr<const FlowLines>& lines() const { return lines_; }
  void draw(const View& view, const Placement& placement) const;

 private:
  std::shared_ptr<const FlowLines> lines_;
  SegmentPass segment_pass_;
  MarkPass mark_pass_;
  Buffer streamlines_, tracks_, past_, later_, separation_, attachment_, orbits_, attracting_, repelling_,
      separatrices_, with_flow_, against_flow_;
};

}  // namespace nacre
