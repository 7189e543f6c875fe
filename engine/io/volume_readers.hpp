// Nacre: the readers of volumes, one per family of formats.
#pragma once

#include <filesystem>

#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// Each reads one file. Throws Error as `read_volume` does.
Volume read_nrrd(const std::filesystem::path& path);  ///< .nrrd .nhdr, through teem
Volume read_nrrd_layer(const std::filesystem::path& path, int layer);
Volume read_nifti(
    const std::filesystem::path& path);              ///< .nii, .hdr and .img; NIfTI-1, -2 and ANALYZE, header by nifti
Volume read_inr(const std::filesystem::path& path);  ///< .inr, INRIMAGE-4
Volume read_mgh(const std::filesystem::path& path);  ///< .mgh .mgz of FreeSurfer
Volume read_vti(const std::filesystem::path& path);  ///< .vti of one piece
Volume read_metaimage(const std::filesystem::path& path);   ///< .mhd .mha with one data file
Volume read_vtk_volume(const std::filesystem::path& path);  ///< .slc .vtk, in a child process

}  // namespace nacre
