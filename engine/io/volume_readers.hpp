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
Volume read_vtk_volume(const std::filesystem::path& path);  ///< .slc .vtk .vtkhdf, in a child process
Volume read_dicom(const std::filesystem::path& path);       ///< a folder with one series, or one of its files, or a SEG
Volume read_dicom_layer(const std::filesystem::path& path, int layer);

/// The same, but values that lie in the file as they are stay there (see mapped_values.hpp).
Volume map_nrrd(const std::filesystem::path& path);
Volume map_nifti(const std::filesystem::path& path);
Volume map_metaimage(const std::filesystem::path& path);

/// Whether a file begins as DICOM does, or one of the first files of a folder.
bool is_dicom(const std::filesystem::path& path);

/// Whether `nacre-dicom-import` exists: beside this program, or where the environment variable NACRE_DICOM_IMPORT says.
bool dicom_child_available();

}  // namespace nacre
