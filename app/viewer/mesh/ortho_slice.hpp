// Nacre: slices along the axes of a volume, as they are looked at. No OpenGL here.
#pragma once

#include <array>
#include <string>

#include "app/viewer/mesh/viewed_volume.hpp"
#include "app/viewer/scene/slice_views.hpp"

namespace nacre {

/// The axis of the volume that runs most along each axis of the world; each of them once.
std::array<int, 3> volume_axes(const MeshInput& input);

/// The voxel of the crosshair, by the shares of the volume that the knob says.
Int3 crosshair_voxel(const MeshInput& input, const Vec3d& shares);
/// The shares of a voxel's centre; beyond the volume, of the last voxel.
Vec3d crosshair_shares(const MeshInput& input, const Vec3d& voxel);

/// One of the three: through the centres of a layer of voxels.
struct OrthoSlice {
  int axis = 0;   ///< of the volume, across it
  int layer = 0;  ///< of voxels along that axis
  SlicePlane plane{};
  Vec3d right, up;  ///< unit, in the world: how it lies in the picture
  double width = 1, height = 1;

  Camera camera(double aspect) const;
};

/// Slice k of 0..2, across x, y and z. x is to the right and z up, y to the right or up. Where the file says what the
/// axes of the world are, as radiologists hold them: the patient's right is on the left, the front above or left.
OrthoSlice ortho_slice(const ViewedVolume& volume, const Vec3d& shares, int k);

/// What is written on it. Directions have the names of the file's space where it has one: R, L, A, P, S, I.
SliceCaption ortho_caption(const ViewedVolume& volume, const OrthoSlice& slice, int k);

}  // namespace nacre
