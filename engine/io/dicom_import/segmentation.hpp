// Nacre: DICOM segmentation objects (SEG).
#pragma once

#include <gdcmFile.h>

#include "engine/io/dicom_import/volume_file.hpp"

namespace nacre::dicom_import {

/// The segments of a SEG object as labels: their numbers. Segments that overlap go into several layers. Throws
/// std::runtime_error if it is fractional, compressed (but for 8-bit ones), or incomplete.
VolumeFile read_segmentation(const gdcm::File& file, const std::filesystem::path& path);

}  // namespace nacre::dicom_import
