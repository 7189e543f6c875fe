// Nacre: three orthogonal slices of a volume on the graphics device, with the outlines of the mesh.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "app/viewer/mesh/mesh_results.hpp"
#include "app/viewer/mesh/ortho_slice.hpp"
#include "engine/render/segment_pass.hpp"
#include "engine/render/slice_pass.hpp"

namespace nacre {

/// What a ray meets on a slice: position, value and material, for people.
std::optional<ProbeResult> probe_slice(const ViewedVolume& volume, const SlicePlane& plane, const Vec3d& from,
                                       const Vec3d& along);

/// What is shown on the slices.
struct SliceContent {
  std::shared_ptr<const ViewedVolume> volume;
  std::shared_ptr<const SurfaceMesh> mesh;  ///< whose outlines are drawn; null: none
  Vec3d crosshair;                          ///< shares
  bool materials = false;                   ///< instead of a scalar volume's values
  std::array<double, 2> range{0, 1};        ///< of these, black and white
  std::vector<Color> palette;               ///< per material
  std::vector<bool> drawn;                  ///< per material: outlines
};

/// Images and outlines are made where they are drawn and differ from the last ones.
class OrthoSlices : public SliceViews {
 public:
  void show(SliceContent content) { content_ = std::move(content); }
  /// The three planes in the view, each with a border in its colour.
  void draw_planes(const View& view);

  Camera camera(int k, double aspect) const override { return slice(k).camera(aspect); }
  void draw(int k, const View& view) override;
  SliceCaption caption(int k) const override { return ortho_caption(*content_.volume, slice(k), k); }
  std::string crosshair_at(int k, const Vec3d& point) const override;
  std::string crosshair_after(int k, int steps) const override;
  std::optional<ProbeResult> probe(int k, const Vec3d& from, const Vec3d& along) const override;

  int images_made() const { return images_made_; }
  int outlines_made() const { return outlines_made_; }

 private:
  struct Outline {
    std::size_t material;
    Buffer segments;
  };
  /// What something was made for.
  struct Made {
    std::shared_ptr<const void> from;  ///< a volume or a mesh
    int layer = -1;
    bool materials = false;
    std::array<double, 2> range{};
    std::vector<Color> palette;
    std::vector<bool> drawn;
    bool operator==(const Made&) const = default;
  };
  struct Shown {
    SlicePass pass;
    Made image, outline;
    Vec3d origin;  ///< of the segments
    std::vector<Outline> outlines;
  };

  OrthoSlice slice(int k) const { return ortho_slice(*content_.volume, content_.crosshair, k); }
  void make_image(int k, const OrthoSlice& slice);
  void make_outline(int k, const OrthoSlice& slice);
  void draw_outlines(const Shown& shown, const View& view) const;
  void draw_crosshair(int k, const OrthoSlice& slice, const View& view) const;
  void draw_lines(const View& view, const Vec3d& origin, const std::vector<LineSegment>& lines,
                  const std::array<float, 3>& colour, bool through) const;

  SliceContent content_;
  std::array<Shown, 3> shown_;
  SegmentPass lines_;
  int images_made_ = 0, outlines_made_ = 0;
};

}  // namespace nacre
