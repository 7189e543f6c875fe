// Nacre: the volume of DICOM files, and the file through which the parent gets it.
#include "engine/io/dicom_import/volume_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <locale>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace nacre::dicom_import {
namespace {

constexpr double uneven = 0.02;  // of a spacing: positions are written with few digits

bool is_unit(const Vec& v) { return std::abs(dot(v, v) - 1) < 1e-3; }

std::string one_line(const std::string& text) {
  std::string line = text;
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

std::string vector_text(const Vec& v) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  text << '(' << v[0] << ',' << v[1] << ',' << v[2] << ')';
  return text.str();
}

/// The usual step from slice to slice: the median; without gaps in mind it is also the smallest.
double usual_step(const std::vector<double>& positions, bool gaps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < positions.size(); ++i) steps.push_back(positions[i] - positions[i - 1]);
  std::sort(steps.begin(), steps.end());
  return gaps ? steps.front() : steps[steps.size() / 2];
}

}  // namespace

void check(const SliceGeometry& s) {
  if (s.size[0] == 0 || s.size[1] == 0) throw std::runtime_error("its images have no pixels");
  for (const double spacing : s.spacing)
    if (!(spacing > 0) || !std::isfinite(spacing)) throw std::runtime_error("it does not say how far apart pixels are");
  if (!is_unit(s.row) || !is_unit(s.column) || std::abs(dot(s.row, s.column)) > 1e-3)
    throw std::runtime_error("the directions of its images are no unit vectors at right angles");
}

std::size_t checked_size(const SliceGeometry& s, std::size_t count, std::size_t bytes) {
  const double size = double(s.size[0]) * double(s.size[1]) * double(count) * double(bytes);
  const double memory = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGE_SIZE));
  if (size > memory) throw std::runtime_error("it is larger than memory");
  return s.size[0] * s.size[1] * count * bytes;
}

SliceStack stack_slices(const SliceGeometry& slices, const std::vector<Vec>& origins, double thickness, bool gaps,
                        bool repeated) {
  const Vec normal = slices.normal();
  std::vector<double> along(origins.size());
  for (std::size_t i = 0; i < origins.size(); ++i) {
    along[i] = dot(origins[i], normal);
    if (!std::isfinite(along[i])) throw std::runtime_error("the position of an image is not a number");
  }
  std::vector<double> positions = along;
  std::sort(positions.begin(), positions.end());
  const double fine = 1e-3 * std::min(slices.spacing[0], slices.spacing[1]);
  const auto same = [&](double a, double b) { return b - a < fine; };
  const std::size_t given = positions.size();
  positions.erase(std::unique(positions.begin(), positions.end(), same), positions.end());
  if (!repeated && positions.size() < given)
    throw std::runtime_error(
        "it has several images of one place, such as times or echoes: keep one of them in the folder");
  SliceStack stack;
  stack.spacing = positions.size() > 1 ? usual_step(positions, gaps) : thickness > 0 ? thickness : 1;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    const double steps = (positions[i] - positions[i - 1]) / stack.spacing;
    const bool even = std::abs(steps - std::round(steps)) < uneven * std::max(1.0, steps) && (gaps || steps < 1.5);
    if (!even)
      throw std::runtime_error("its slices are not evenly spaced, or one is missing: between " +
                               std::to_string(positions[i - 1]) + " and " + std::to_string(positions[i]) + " mm");
  }
  if (positions.size() > 1) {  // exact over the whole stack
    const double steps = std::round((positions.back() - positions.front()) / stack.spacing);
    if (steps > 65536) throw std::runtime_error("its slices are too far apart");
    stack.spacing = (positions.back() - positions.front()) / steps;
    stack.count = std::size_t(steps) + 1;
  } else {
    stack.count = 1;
  }
  const std::size_t first = std::size_t(std::min_element(along.begin(), along.end()) - along.begin());
  stack.origin = origins[first];
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const Vec shift = (origins[i] - stack.origin) - normal * (along[i] - along[first]);
    if (std::sqrt(dot(shift, shift)) > 0.1 * std::max(slices.spacing[0], slices.spacing[1]))
      throw std::runtime_error("its slices are moved against each other, as with a tilted gantry: resample it first");
    stack.slot.push_back(std::size_t(std::lround((along[i] - along[first]) / stack.spacing)));
  }
  return stack;
}

void write(const VolumeFile& volume, const std::filesystem::path& file) {
  const SliceGeometry& s = volume.slices;
  std::ofstream out(file, std::ios::binary);
  out.imbue(std::locale::classic());
  const bool layered = volume.layers > 1;
  out << "NRRD0004\ntype: " << volume.type << "\ndimension: " << (layered ? 4 : 3)
      << "\nspace: left-posterior-superior\nsizes:";
  if (layered) out << ' ' << volume.layers;
  out << ' ' << s.size[0] << ' ' << s.size[1] << ' ' << volume.stack.count << "\nspace directions:";
  if (layered) out << " none";
  out << ' ' << vector_text(s.row * s.spacing[0]) << ' ' << vector_text(s.column * s.spacing[1]) << ' '
      << vector_text(s.normal() * volume.stack.spacing) << "\nkinds:" << (layered ? " list" : "")
      << " domain domain domain\nendian: little\nencoding: raw\nspace origin: " << vector_text(volume.stack.origin)
      << '\n';
  for (std::size_t i = 0; i < volume.segments.size(); ++i) {
    const Segment& segment = volume.segments[i];
    const std::string key = "Segment" + std::to_string(i) + "_";
    out << key << "Name:=" << one_line(segment.name) << '\n'
        << key << "LabelValue:=" << segment.label << '\n'
        << key << "Layer:=" << segment.layer << '\n';
  }
  out << '\n';
  out.write(volume.values.data(), std::streamsize(volume.values.size()));
  if (!out.flush()) throw std::runtime_error("the temporary " + file.string() + " cannot be written");
}

}  // namespace nacre::dicom_import
