// Nacre: a series of images, or one image of several frames, as a volume.
#include "engine/io/dicom_import/series.hpp"

#include <gdcmImageReader.h>
#include <gdcmReader.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

#include "engine/io/dicom_import/frames.hpp"
#include "engine/io/dicom_import/segmentation.hpp"

namespace nacre::dicom_import {
namespace {

namespace fs = std::filesystem;

const gdcm::Tag class_uid{0x0008, 0x0016}, series_uid{0x0020, 0x000e}, series_name{0x0008, 0x103e},
    pixel_data{0x7fe0, 0x0010}, thickness{0x0018, 0x0050}, spacing{0x0018, 0x0088}, position{0x0020, 0x0032};
constexpr const char* segmentation_class = "1.2.840.10008.5.1.4.1.1.66.4";
constexpr std::size_t most_files = 100000;

struct Header {
  fs::path file;
  std::string series, name;
  bool segmentation = false, placed = false;
};

/// Nothing if it is no DICOM file, or one without pixels.
std::optional<Header> read_header(const fs::path& file) {
  if (!is_dicom(file)) return {};
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  if (!reader.ReadUpToTag(pixel_data)) return {};
  const gdcm::DataSet& data = reader.GetFile().GetDataSet();
  Header header{file, text(data, series_uid), text(data, series_name), false, false};
  header.segmentation = text(data, class_uid) == segmentation_class;
  header.placed = data.FindDataElement(position) || !items(data, gdcm::Tag(0x5200, 0x9230)).empty();
  return header;
}

std::vector<Header> headers_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
    if (files.size() > most_files) throw std::runtime_error("the folder has too many files");
  }
  std::sort(files.begin(), files.end());
  std::vector<Header> headers;
  for (const fs::path& file : files)
    if (auto header = read_header(file)) headers.push_back(std::move(*header));
  return headers;
}

/// One slice, or all frames of an image.
struct Slices {
  SliceGeometry geometry;
  std::vector<Vec> origins;
  std::vector<double> values;  ///< as the scanner means them
  double thickness = 0;
};

template <class T>
void append(std::vector<double>& out, const std::vector<char>& buffer, double slope, double intercept) {
  const std::size_t count = buffer.size() / sizeof(T);
  out.reserve(out.size() + count);
  for (std::size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, buffer.data() + i * sizeof(T), sizeof(T));
    out.push_back(slope * double(value) + intercept);
  }
}

std::vector<double> values_of(const gdcm::Image& image, const fs::path& file) {
  std::vector<char> buffer(image.GetBufferLength());
  if (buffer.empty() || !image.GetBuffer(buffer.data()))
    throw std::runtime_error("the pixels of " + file.filename().string() + " cannot be unpacked");
  std::vector<double> values;
  const double slope = image.GetSlope(), intercept = image.GetIntercept();
  switch (gdcm::PixelFormat::ScalarType(image.GetPixelFormat())) {
    case gdcm::PixelFormat::UINT8: append<std::uint8_t>(values, buffer, slope, intercept); break;
    case gdcm::PixelFormat::INT8: append<std::int8_t>(values, buffer, slope, intercept); break;
    case gdcm::PixelFormat::UINT12:
    case gdcm::PixelFormat::UINT16: append<std::uint16_t>(values, buffer, slope, intercept); break;
    case gdcm::PixelFormat::INT12:
    case gdcm::PixelFormat::INT16: append<std::int16_t>(values, buffer, slope, intercept); break;
    case gdcm::PixelFormat::UINT32: append<std::uint32_t>(values, buffer, slope, intercept); break;
    case gdcm::PixelFormat::INT32: append<std::int32_t>(values, buffer, slope, intercept); break;
    case gdcm::PixelFormat::FLOAT32: append<float>(values, buffer, slope, intercept); break;
    case gdcm::PixelFormat::FLOAT64: append<double>(values, buffer, slope, intercept); break;
    default: throw std::runtime_error(file.filename().string() + " has pixels of an unknown type");
  }
  return values;
}

Slices read_slices(const fs::path& file) {
  gdcm::ImageReader reader;
  reader.SetFileName(file.c_str());
  if (!reader.Read()) throw std::runtime_error(file.filename().string() + " holds no image that can be read");
  const gdcm::Image& image = reader.GetImage();
  if (image.GetPixelFormat().GetSamplesPerPixel() != 1) throw std::runtime_error("its images are in colour");
  const gdcm::DataSet& data = reader.GetFile().GetDataSet();
  Slices slices;
  if (auto frames = read_frames(data)) {
    slices.geometry = frames->slices;
    slices.origins = std::move(frames->origins);
    slices.thickness = frames->thickness;
  } else {
    const double* d = image.GetDirectionCosines();
    const std::size_t frames_here = image.GetNumberOfDimensions() > 2 ? image.GetDimension(2) : 1;
    slices.geometry.size = {image.GetDimension(0), image.GetDimension(1)};
    slices.geometry.spacing = {image.GetSpacing(0), image.GetSpacing(1)};
    slices.geometry.row = {d[0], d[1], d[2]};
    slices.geometry.column = {d[3], d[4], d[5]};
    check(slices.geometry);
    const Vec normal = slices.geometry.normal();
    for (const gdcm::Tag& tag : {spacing, thickness})
      if (const auto value = numbers(data, tag); !value.empty() && slices.thickness <= 0) slices.thickness = value[0];
    const double step = slices.thickness > 0 ? slices.thickness : 1;
    for (std::size_t k = 0; k < frames_here; ++k) {
      const Vec along = normal * (step * double(k));
      slices.origins.push_back(
          {image.GetOrigin(0) + along[0], image.GetOrigin(1) + along[1], image.GetOrigin(2) + along[2]});
    }
  }
  checked_size(slices.geometry, slices.origins.size(), sizeof(double));
  slices.values = values_of(image, file);
  if (slices.values.size() < slices.geometry.size[0] * slices.geometry.size[1] * slices.origins.size())
    throw std::runtime_error("the pixels of " + file.filename().string() + " are cut short");
  return slices;
}

bool fit(const SliceGeometry& a, const SliceGeometry& b) {
  const auto near = [](const Vec& u, const Vec& v) { return dot(u - v, u - v) < 1e-6; };
  return a.size == b.size && std::abs(a.spacing[0] - b.spacing[0]) < 1e-4 * a.spacing[0] &&
         std::abs(a.spacing[1] - b.spacing[1]) < 1e-4 * a.spacing[1] && near(a.row, b.row) && near(a.column, b.column);
}

template <class T>
std::vector<char> as_bytes(const std::vector<double>& values) {
  std::vector<char> bytes(values.size() * sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T value = T(values[i]);
    std::memcpy(bytes.data() + i * sizeof(T), &value, sizeof(T));
  }
  return bytes;
}

/// In the smallest of short, int and float that holds all values as they are.
void set_values(VolumeFile& volume, const std::vector<double>& values) {
  bool whole = true;
  double low = 0, high = 0;
  for (const double v : values) {
    whole = whole && v == std::floor(v);
    low = std::min(low, v), high = std::max(high, v);
  }
  const auto within = [&](auto zero) {
    using Limits = std::numeric_limits<decltype(zero)>;
    return whole && low >= double(Limits::min()) && high <= double(Limits::max());
  };
  const bool small = within(std::int16_t{}), fits = within(std::int32_t{});
  volume.type = small ? "short" : fits ? "int" : "float";
  volume.bytes_per_voxel = small ? 2 : 4;
  volume.values = small  ? as_bytes<std::int16_t>(values)
                  : fits ? as_bytes<std::int32_t>(values)
                         : as_bytes<float>(values);
}

VolumeFile volume_of(const std::vector<Header>& files) {
  Slices all;
  for (const Header& header : files) {
    Slices slices = read_slices(header.file);
    if (all.origins.empty()) {
      all.geometry = slices.geometry;
      all.thickness = slices.thickness;
      checked_size(all.geometry, files.size() * slices.origins.size(), sizeof(double));
    } else if (!fit(all.geometry, slices.geometry)) {
      throw std::runtime_error(header.file.filename().string() + " differs from " + files[0].file.filename().string() +
                               " in size, spacing or direction");
    }
    all.origins.insert(all.origins.end(), slices.origins.begin(), slices.origins.end());
    all.values.insert(all.values.end(), slices.values.begin(), slices.values.end());
  }
  VolumeFile volume;
  volume.slices = all.geometry;
  volume.stack = stack_slices(all.geometry, all.origins, all.thickness, false, false);
  const std::size_t slice = all.geometry.size[0] * all.geometry.size[1];
  std::vector<double> sorted(slice * volume.stack.count);
  for (std::size_t k = 0; k < all.origins.size(); ++k)
    std::copy_n(all.values.begin() + std::ptrdiff_t(k * slice), slice,
                sorted.begin() + std::ptrdiff_t(volume.stack.slot[k] * slice));
  set_values(volume, sorted);
  return volume;
}

VolumeFile segmentation_of(const fs::path& file) {
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  if (!reader.Read()) throw std::runtime_error("it is damaged");
  return read_segmentation(reader.GetFile(), file);
}

VolumeFile only_series(const std::vector<Header>& headers, const fs::path& folder) {
  std::map<std::string, std::vector<Header>> series;
  for (const Header& header : headers)
    if (header.placed && !header.segmentation) series[header.series].push_back(header);
  if (series.empty()) {
    if (headers.size() == 1 && headers[0].segmentation) return segmentation_of(headers[0].file);
    throw std::runtime_error("it holds no images with a place in space");
  }
  if (series.size() == 1) return volume_of(series.begin()->second);
  std::string known;
  for (const auto& [uid, files] : series)
    known += (known.empty() ? "" : "; ") + files[0].name + " (" + std::to_string(files.size()) + ", such as " +
             files[0].file.lexically_relative(folder).string() + ")";
  throw std::runtime_error("it holds " + std::to_string(series.size()) + " series, name a file of one: " + known);
}

}  // namespace

bool is_dicom(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char head[132] = {};
  return stream.read(head, sizeof(head)) && std::memcmp(head + 128, "DICM", 4) == 0;
}

VolumeFile read_series(const fs::path& path) {
  if (fs::is_directory(path)) return only_series(headers_in(path), path);
  const std::optional<Header> own = read_header(path);
  if (!own) throw std::runtime_error("it is no DICOM file");
  if (own->segmentation) return segmentation_of(path);
  std::vector<Header> files;
  for (const auto& entry : fs::directory_iterator(path.parent_path().empty() ? fs::path(".") : path.parent_path()))
    if (entry.is_regular_file())
      if (auto header = read_header(entry.path()); header && header->series == own->series && !header->segmentation)
        files.push_back(std::move(*header));
  std::sort(files.begin(), files.end(), [](const Header& a, const Header& b) { return a.file < b.file; });
  if (files.size() < 2) files = {*own};
  return volume_of(files);
}

}  // namespace nacre::dicom_import
