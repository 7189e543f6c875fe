// Nacre: where the frames of an image lie, as the functional groups of DICOM say it.
#include "engine/io/dicom_import/frames.hpp"

#include <gdcmByteValue.h>
#include <gdcmItem.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmSmartPointer.h>

#include <cmath>
#include <cstring>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace nacre::dicom_import {
namespace {

const gdcm::Tag rows{0x0028, 0x0010}, columns{0x0028, 0x0011};
const gdcm::Tag shared{0x5200, 0x9229}, per_frame{0x5200, 0x9230};
const gdcm::Tag plane_position{0x0020, 0x9113}, position{0x0020, 0x0032};
const gdcm::Tag plane_orientation{0x0020, 0x9116}, orientation{0x0020, 0x0037};
const gdcm::Tag pixel_measures{0x0028, 0x9110}, pixel_spacing{0x0028, 0x0030};
const gdcm::Tag between_slices{0x0018, 0x0088}, slice_thickness{0x0018, 0x0050};
const gdcm::Tag segment_identification{0x0062, 0x000a}, segment_number{0x0062, 0x000b};

/// The first item of a sequence of this frame, else of those that all frames share.
const gdcm::DataSet* macro(const gdcm::DataSet* frame, const gdcm::DataSet* common, const gdcm::Tag& sequence) {
  for (const gdcm::DataSet* part : {frame, common})
    if (part)
      if (const auto found = items(*part, sequence); !found.empty()) return found.front();
  return nullptr;
}

std::vector<double> required(const gdcm::DataSet* data, const gdcm::Tag& tag, std::size_t count, const char* what) {
  const std::vector<double> values = data ? numbers(*data, tag) : std::vector<double>{};
  if (values.size() < count) throw std::runtime_error(std::string("it does not say ") + what);
  return values;
}

bool same_direction(const Vec& a, const Vec& b) { return dot(a - b, a - b) < 1e-6; }

}  // namespace

std::vector<const gdcm::DataSet*> items(const gdcm::DataSet& data, const gdcm::Tag& sequence) {
  std::vector<const gdcm::DataSet*> result;
  if (!data.FindDataElement(sequence)) return result;
  const gdcm::SmartPointer<gdcm::SequenceOfItems> list = data.GetDataElement(sequence).GetValueAsSQ();
  if (!list) return result;
  // With an implicit VR the sequence is parsed here and belongs to nobody else; this process is short.
  static std::vector<gdcm::SmartPointer<gdcm::SequenceOfItems>> kept;
  kept.push_back(list);
  for (std::size_t i = 1; i <= list->GetNumberOfItems(); ++i) result.push_back(&list->GetItem(i).GetNestedDataSet());
  return result;
}

std::string text(const gdcm::DataSet& data, const gdcm::Tag& tag) {
  if (!data.FindDataElement(tag)) return {};
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (!bytes) return {};
  std::string value(bytes->GetPointer(), bytes->GetLength());
  value.resize(std::strlen(value.c_str()));
  while (!value.empty() && value.back() == ' ') value.pop_back();
  return value;
}

std::vector<double> numbers(const gdcm::DataSet& data, const gdcm::Tag& tag) {
  std::vector<double> values;
  std::istringstream list(text(data, tag));
  for (std::string word; std::getline(list, word, '\\');) {
    std::istringstream stream(word);
    stream.imbue(std::locale::classic());
    double value = 0;
    if (!(stream >> value) || !std::isfinite(value)) return {};
    values.push_back(value);
  }
  return values;
}

std::optional<std::uint32_t> whole(const gdcm::DataSet& data, const gdcm::Tag& tag) {
  if (!data.FindDataElement(tag)) return {};
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (!bytes) return {};
  std::uint16_t small = 0;
  std::uint32_t large = 0;
  if (bytes->GetLength() == 2) return std::memcpy(&small, bytes->GetPointer(), 2), small;
  if (bytes->GetLength() == 4) return std::memcpy(&large, bytes->GetPointer(), 4), large;
  return {};
}

std::optional<Frames> read_frames(const gdcm::DataSet& data) {
  const auto frames = items(data, per_frame);
  if (frames.empty()) return {};
  const auto for_all = items(data, shared);
  const gdcm::DataSet* common = for_all.empty() ? nullptr : for_all.front();
  Frames result;
  result.slices.size = {whole(data, columns).value_or(0), whole(data, rows).value_or(0)};
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto p = required(macro(frames[k], common, plane_position), position, 3, "where its frames are");
    const auto d = required(macro(frames[k], common, plane_orientation), orientation, 6, "how its frames are turned");
    const gdcm::DataSet* measures = macro(frames[k], common, pixel_measures);
    const auto s = required(measures, pixel_spacing, 2, "how far apart pixels are");
    const Vec row{d[0], d[1], d[2]}, column{d[3], d[4], d[5]};
    if (k == 0) {
      result.slices.row = row;
      result.slices.column = column;
      result.slices.spacing = {s[1], s[0]};
      for (const gdcm::Tag& tag : {between_slices, slice_thickness})
        if (const auto value = numbers(*measures, tag); !value.empty() && result.thickness <= 0)
          result.thickness = value[0];
    } else if (!same_direction(row, result.slices.row) || !same_direction(column, result.slices.column)) {
      throw std::runtime_error("its frames are turned against each other");
    }
    result.origins.push_back({p[0], p[1], p[2]});
    const gdcm::DataSet* segment = macro(frames[k], common, segment_identification);
    result.segments.push_back(segment ? whole(*segment, segment_number).value_or(0) : 0);
  }
  check(result.slices);
  return result;
}

}  // namespace nacre::dicom_import
