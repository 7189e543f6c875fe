// Nacre: draws an image as a parallelogram in the world: a slice of a volume.
#pragma once

#include "engine/gl/texture.hpp"
#include "engine/picture/image.hpp"
#include "engine/render/view.hpp"

namespace nacre {

/// Draws into what is bound; pixels that are not opaque are left out, and the clip plane does not cut it.
class SlicePass {
 public:
  SlicePass();
  ~SlicePass();
  SlicePass(const SlicePass&) = delete;
  SlicePass& operator=(const SlicePass&) = delete;

  /// The image to show from now on; row 0 is at the corner. `smooth`: linear between pixels. An empty image shows
  /// nothing.
  void set_image(const Image& image, bool smooth);
  /// Its position: from `corner`, the image's x runs along `across` and its y along `up` (world, to the far side).
  void set_frame(const Vec3d& corner, const Vec3d& across, const Vec3d& up);
  void draw(const View& view) const;

 private:
  Program program_;
  TextureName texture_;
  GLuint array_ = 0;
  Placement placement_{1.0};
};

}  // namespace nacre
