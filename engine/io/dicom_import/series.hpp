// Nacre: a series of images, or one image of several frames, as a volume.
#pragma once

#include <filesystem>

#include "engine/io/dicom_import/volume_file.hpp"

namespace nacre::dicom_import {

/// Whether the file begins as DICOM does.
bool is_dicom(const std::filesystem::path& file);

/// Of a folder: its only series (in it or its folders). Of a file: its frames, or the series that it is one slice of,
/// from its folder; or, if it is one, the segmentation. Throws std::runtime_error if there is no volume in it, or more
/// than one.
VolumeFile read_series(const std::filesystem::path& path);

}  // namespace nacre::dicom_import
