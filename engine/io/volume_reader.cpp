// Nacre: volumes by extension.
#include "engine/io/volume_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <new>

#include "compute/device/error.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/file_steps.hpp"
#include "engine/io/label_names.hpp"
#include "engine/io/registry.hpp"
#include "engine/io/volume_readers.hpp"
#include "engine/io/vtk_child.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// The third or fourth line of a legacy file names its kind of data.
bool is_legacy_image(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(1024, '\0');
  file.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
  std::transform(head.begin(), head.end(), head.begin(), [](unsigned char c) { return std::toupper(c); });
  const std::size_t dataset = head.find("\nDATASET");
  return dataset != head.npos && head.find("STRUCTURED_POINTS", dataset) < dataset + 40;
}

/// The attribute Type of the group VTKHDF is a word in the file's text.
bool is_hdf_image(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(1 << 16, '\0');
  file.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
  return head.find("ImageData") != head.npos;
}

}  // namespace

const std::vector<VolumeFormat>& volume_formats() {
  static const std::vector<VolumeFormat> formats = {
      {"NRRD", {"nrrd", "nhdr"}, false, nullptr, read_nrrd, read_nrrd_layer, map_nrrd},
      {"NIfTI", {"nii", "hdr", "img"}, true, nullptr, read_nifti, nullptr, map_nifti},
      {"INR", {"inr"}, true, nullptr, read_inr},
      {"FreeSurfer", {"mgz", "mgh"}, false, nullptr, read_mgh},
      {"VTK image", {"vti"}, false, nullptr, read_vti},
      {"MetaImage", {"mhd", "mha"}, false, nullptr, read_metaimage, nullptr, map_metaimage},
      {"DICOM", {"dcm"}, false, dicom_child_available, read_dicom, read_dicom_layer},
      {"SLC", {"slc"}, false, vtk_child_available, read_vtk_volume},
      {"VTK image", {"vtk"}, false, vtk_child_available, read_vtk_volume},
      {"VTKHDF image", {"vtkhdf"}, false, vtk_child_available, read_vtk_volume},
  };
  return formats;
}

const VolumeFormat* find_volume_format(const fs::path& path) {
  const std::string extension = format_extension(path);
  const bool packed = lower_extension(path) == ".gz";
  for (const VolumeFormat& format : volume_formats()) {
    const auto& extensions = format.extensions;
    if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) continue;
    if (packed && !format.gzip) return nullptr;
    if (extension == "vtk" && !is_legacy_image(path)) return nullptr;
    if (extension == "vtkhdf" && !is_hdf_image(path)) return nullptr;
    return &format;
  }
  // Files of scanners are often called by a number.
  if (!find_format(extension) && !goes_through_vtk(path) && !is_file_list(path) && is_dicom(path))
    return &*std::find_if(volume_formats().begin(), volume_formats().end(),
                          [](const VolumeFormat& format) { return format.name == "DICOM"; });
  return nullptr;
}

bool is_volume_file(const fs::path& path) { return find_volume_format(path) != nullptr; }

void add_label_names(Volume& volume, const fs::path& names) {
  if (names.empty()) return;
  LabelTable known = read_label_table(names);
  known.names.merge(volume.label_names);
  volume.label_names = std::move(known.names);
  known.colours.merge(volume.label_colours);
  volume.label_colours = std::move(known.colours);
}

Volume read_volume(const fs::path& path, const VolumeChoice& choice) {
  const VolumeFormat* format = find_volume_format(path);
  if (!format || format->name != "DICOM") require_file(path);
  if (!format)
    fail_reading(path, "its name is not that of a known volume format",
                 fmt::format("known are {}", fmt::join(volume_extensions(), " ")));
  if (choice.layer != all_layers && !format->read_layer)
    fail_reading(path, fmt::format("{} files have no layers", format->name), "leave --layer out");
  try {
    const auto whole = choice.mapped && format->map ? format->map : format->read;
    Volume volume = choice.layer == all_layers ? whole(path) : format->read_layer(path, choice.layer);
    volume.name = path.filename().string();
    add_label_names(volume, choice.names);
    return volume;
  } catch (const std::bad_alloc&) {
    fail_reading(path, "it does not fit in memory", "open a smaller volume");
  }
}

std::vector<std::string> volume_extensions() {
  std::vector<std::string> extensions;
  for (const VolumeFormat& format : volume_formats())
    if (!format.available || format.available())
      for (const std::string& extension : format.extensions) {
        extensions.push_back("." + extension);
        if (format.gzip) extensions.push_back("." + extension + ".gz");
      }
  return extensions;
}

}  // namespace nacre
