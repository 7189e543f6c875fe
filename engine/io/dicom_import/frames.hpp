// Nacre: where the frames of an image lie, as the functional groups of DICOM say it.
#pragma once

#include <gdcmDataSet.h>

#include <optional>

#include "engine/io/dicom_import/volume_file.hpp"

namespace nacre::dicom_import {

/// The items of a sequence; empty if it is absent.
std::vector<const gdcm::DataSet*> items(const gdcm::DataSet& data, const gdcm::Tag& sequence);

/// A text without the blanks that pad it; empty if it is absent.
std::string text(const gdcm::DataSet& data, const gdcm::Tag& tag);

/// Numbers written as text (DS, IS), separated by backslashes.
std::vector<double> numbers(const gdcm::DataSet& data, const gdcm::Tag& tag);

/// A binary number of 16 or 32 bits (US, UL); nothing if it is absent.
std::optional<std::uint32_t> whole(const gdcm::DataSet& data, const gdcm::Tag& tag);

/// All frames of an image that describes them one by one.
struct Frames {
  SliceGeometry slices;
  std::vector<Vec> origins;
  std::vector<std::uint32_t> segments;  ///< of a segmentation; else zeros
  double thickness = 0;                 ///< 0: it does not say
};

/// Nothing if the image has no such description. Throws std::runtime_error if it is incomplete, or if frames differ in
/// direction.
std::optional<Frames> read_frames(const gdcm::DataSet& data);

}  // namespace nacre::dicom_import
