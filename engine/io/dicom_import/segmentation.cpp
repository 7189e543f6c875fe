// Nacre: DICOM segmentation objects (SEG).
#include "engine/io/dicom_import/segmentation.hpp"

#include <gdcmByteValue.h>
#include <gdcmImageReader.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>

#include "engine/io/dicom_import/frames.hpp"

namespace nacre::dicom_import {
namespace {

const gdcm::Tag kind{0x0062, 0x0001}, segment_sequence{0x0062, 0x0002}, number_tag{0x0062, 0x0004},
    label_tag{0x0062, 0x0005}, bits_allocated{0x0028, 0x0100}, pixel_data{0x7fe0, 0x0010};

/// The pixels of all frames as bytes, one frame after the other.
std::vector<char> read_pixels(const gdcm::File& file, const std::filesystem::path& path, std::size_t pixels,
                              unsigned bits) {
  std::vector<char> values(pixels);
  if (bits == 1) {
    const gdcm::ByteValue* bytes = file.GetDataSet().FindDataElement(pixel_data)
                                       ? file.GetDataSet().GetDataElement(pixel_data).GetByteValue()
                                       : nullptr;
    if (!bytes) throw std::runtime_error("its pixels are compressed: export it without compression");
    if (bytes->GetLength() < (pixels + 7) / 8) throw std::runtime_error("its pixels are cut short");
    const char* packed = bytes->GetPointer();  // the lowest bit first, frames without a gap
    for (std::size_t i = 0; i < pixels; ++i) values[i] = char(packed[i / 8] >> (i % 8) & 1);
    return values;
  }
  gdcm::ImageReader reader;
  reader.SetFileName(path.c_str());
  if (!reader.Read()) throw std::runtime_error("its pixels cannot be read");
  if (reader.GetImage().GetBufferLength() < pixels) throw std::runtime_error("its pixels are cut short");
  std::vector<char> buffer(reader.GetImage().GetBufferLength());
  if (!reader.GetImage().GetBuffer(buffer.data())) throw std::runtime_error("its pixels cannot be unpacked");
  std::copy_n(buffer.begin(), pixels, values.begin());
  return values;
}

/// Numbers and names of the segments, in the order of the file.
std::vector<Segment> read_segments(const gdcm::DataSet& data) {
  std::vector<Segment> segments;
  for (const gdcm::DataSet* each : items(data, segment_sequence)) {
    const auto number = whole(*each, number_tag);
    if (!number) throw std::runtime_error("one of its segments has no number");
    segments.push_back({text(*each, label_tag), std::int64_t(*number), 0});
  }
  if (segments.empty()) throw std::runtime_error("it has no segments");
  return segments;
}

/// Frames of one segment each become labels; a segment that overlaps with those before goes into a layer of its own.
class Layers {
 public:
  Layers(std::size_t slice, std::size_t slices) : slice_(slice), size_(slice * slices) {}

  std::size_t add(const std::vector<std::pair<std::size_t, const char*>>& frames, std::uint16_t label) {
    std::size_t layer = 0;
    while (layer < layers_.size() && overlaps(layers_[layer], frames)) ++layer;
    if (layer == layers_.size()) layers_.emplace_back(size_, std::uint16_t(0));
    for (const auto& [slot, pixels] : frames)
      for (std::size_t i = 0; i < slice_; ++i)
        if (pixels[i]) layers_[layer][slot * slice_ + i] = label;
    return layer;
  }

  std::size_t count() const { return layers_.size(); }

  /// Layer fastest.
  std::vector<char> interleaved() const {
    std::vector<std::uint16_t> values(size_ * layers_.size());
    for (std::size_t layer = 0; layer < layers_.size(); ++layer)
      for (std::size_t i = 0; i < size_; ++i) values[i * layers_.size() + layer] = layers_[layer][i];
    std::vector<char> bytes(values.size() * sizeof(std::uint16_t));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }

 private:
  bool overlaps(const std::vector<std::uint16_t>& layer,
                const std::vector<std::pair<std::size_t, const char*>>& frames) const {
    for (const auto& [slot, pixels] : frames)
      for (std::size_t i = 0; i < slice_; ++i)
        if (pixels[i] && layer[slot * slice_ + i]) return true;
    return false;
  }

  std::size_t slice_, size_;
  std::vector<std::vector<std::uint16_t>> layers_;
};

}  // namespace

VolumeFile read_segmentation(const gdcm::File& file, const std::filesystem::path& path) {
  const gdcm::DataSet& data = file.GetDataSet();
  const std::string type = text(data, kind);
  if (type == "FRACTIONAL") throw std::runtime_error("it is fractional: export it as a binary segmentation");
  const std::optional<Frames> frames = read_frames(data);
  if (!frames) throw std::runtime_error("it does not say where its frames are");
  const unsigned bits = whole(data, bits_allocated).value_or(0);
  if (bits != 1 && bits != 8) throw std::runtime_error("its pixels have " + std::to_string(bits) + " bits");
  const std::size_t slice = frames->slices.size[0] * frames->slices.size[1], count = frames->origins.size();
  const std::vector<char> pixels = read_pixels(file, path, checked_size(frames->slices, count, 1), bits);

  VolumeFile result;
  result.slices = frames->slices;
  result.stack = stack_slices(frames->slices, frames->origins, frames->thickness, true, true);
  result.segments = read_segments(data);
  result.type = "ushort";
  result.bytes_per_voxel = 2;
  checked_size(frames->slices, result.stack.count * result.segments.size(), 2);
  Layers layers(slice, result.stack.count);
  if (type == "LABELMAP") {
    std::vector<std::uint16_t> values(slice * result.stack.count);
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t i = 0; i < slice; ++i)
        values[result.stack.slot[k] * slice + i] = static_cast<unsigned char>(pixels[k * slice + i]);
    result.values.resize(values.size() * 2);
    std::memcpy(result.values.data(), values.data(), result.values.size());
    return result;
  }
  std::map<std::uint32_t, std::vector<std::pair<std::size_t, const char*>>> of_segment;
  for (std::size_t k = 0; k < count; ++k)
    of_segment[frames->segments[k]].emplace_back(result.stack.slot[k], pixels.data() + k * slice);
  for (Segment& segment : result.segments) {
    if (segment.label < 1 || segment.label > 65535) throw std::runtime_error("a segment has a number out of range");
    const auto found = of_segment.find(std::uint32_t(segment.label));
    if (found != of_segment.end()) segment.layer = layers.add(found->second, std::uint16_t(segment.label));
  }
  if (layers.count() == 0) throw std::runtime_error("none of its segments has a frame");
  result.layers = layers.count();
  result.values = layers.interleaved();
  return result;
}

}  // namespace nacre::dicom_import
