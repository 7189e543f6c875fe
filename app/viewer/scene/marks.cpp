// Nacre: what the user has marked in a scene.
#include "app/viewer/scene/marks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>
#include <numbers>
#include <sstream>

#include "engine/picture/lettering.hpp"
#include "engine/picture/text.hpp"

namespace nacre {
namespace {

constexpr Rgba mark_colour{224, 60, 40, 255};

/// Calls take(stream) for each part of a list.
template <class Take>
void for_parts(const std::string& list, const Take& take) {
  std::istringstream parts(list);
  for (std::string part; std::getline(parts, part, ';');) {
    std::istringstream stream(part);
    take(stream);
  }
}

bool read_point(std::istream& stream, Vec3d& p) { return bool(stream >> p.x >> p.y >> p.z); }

std::string point_text(const Vec3d& p) { return fmt::format("{:.7g} {:.7g} {:.7g}", p.x, p.y, p.z); }

/// Text that no list is parted by.
std::string one_part(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ';' || c == '\n'; }, ',');
  return text;
}

void put_dot(Image& image, const std::array<double, 2>& at, float radius) {
  draw_stroke(image, float(at[0]), float(at[1]), radius, float(at[0]), float(at[1]), radius, mark_colour);
}

/// Beside a position, within the picture.
void put_text(Image& image, const std::array<double, 2>& at, const std::string& text, float pixels, const Rgba& paper) {
  const int width = text_width(text, pixels), height = text_cap_height(pixels);
  const int x = std::clamp(int(at[0] + 0.5 * pixels), 0, std::max(0, image.width - width));
  const int y = std::clamp(int(at[1]) - height / 2, 0, std::max(0, image.height - height));
  draw_lettering(image, x, y, text, pixels, ink_on(paper));
}

}  // namespace

std::vector<Vec3d> parse_ruler(const std::string& text) {
  std::vector<Vec3d> points;
  for_parts(text, [&](std::istream& stream) {
    if (Vec3d p; read_point(stream, p)) points.push_back(p);
  });
  return points;
}

std::string ruler_text(std::span<const Vec3d> points) {
  std::string text;
  for (const Vec3d& p : points) text += (text.empty() ? "" : ";") + point_text(p);
  return text;
}

std::vector<std::string> ruler_lines(std::span<const Vec3d> points, const std::string& unit) {
  std::vector<std::string> lines;
  for (std::size_t k = 1; k < points.size(); ++k)
    lines.push_back(fmt::format("{:.4g}{}", length(points[k] - points[k - 1]), unit.empty() ? "" : " " + unit));
  if (points.size() != 3) return lines;
  const Vec3d a = points[0] - points[1], b = points[2] - points[1];
  const double angle = std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
  lines.push_back(fmt::format("{:.1f}°", angle));
  return lines;
}

std::vector<PlacedNote> parse_notes(const std::string& text) {
  std::vector<PlacedNote> notes;
  for_parts(text, [&](std::istream& stream) {
    PlacedNote note;
    if (read_point(stream, note.position) && std::getline(stream >> std::ws, note.text) && !note.text.empty())
      notes.push_back(std::move(note));
  });
  return notes;
}

std::string notes_text(std::span<const PlacedNote> notes) {
  std::string text;
  for (const PlacedNote& note : notes)
    text += fmt::format("{}{} {}", text.empty() ? "" : ";", point_text(note.position), one_part(note.text));
  return text;
}

std::vector<SavedCamera> parse_cameras(const std::string& text) {
  std::vector<SavedCamera> cameras;
  for_parts(text, [&](std::istream& stream) {
    SavedCamera saved;
    Camera& c = saved.camera;
    if (!std::getline(stream, saved.name, ':') || saved.name.empty()) return;
    if (!read_point(stream, c.eye) || !read_point(stream, c.target) || !read_point(stream, c.up)) return;
    if (!(stream >> c.height) || !(c.height > 0) || !(length(c.eye - c.target) > 0) || !(length(c.up) > 0)) return;
    std::string projection;
    c.orthographic = stream >> projection && projection == "o";
    cameras.push_back(std::move(saved));
  });
  return cameras;
}

std::string cameras_text(std::span<const SavedCamera> cameras) {
  std::string text;
  for (const SavedCamera& saved : cameras) {
    const Camera& c = saved.camera;
    std::string name = one_part(saved.name);
    std::replace(name.begin(), name.end(), ':', ' ');
    text += fmt::format("{}{}:{} {} {} {:.7g}{}", text.empty() ? "" : ";", name, point_text(c.eye),
                        point_text(c.target), point_text(c.up), c.height, c.orthographic ? " o" : "");
  }
  return text;
}

std::optional<std::array<double, 2>> pixel_of(const View& view, const Vec3d& point) {
  const Vec3d seen = point - view.camera.eye;
  const glm::dvec4 clip = view.clip_from_seen() * glm::dvec4(seen.x, seen.y, seen.z, 1);
  if (!(clip.w > 0)) return {};
  return std::array{0.5 * (clip.x / clip.w + 1) * view.width, 0.5 * (1 - clip.y / clip.w) * view.height};
}

Image marks_sheet(const View& view, const std::string& ruler, const std::string& notes, const std::string& unit,
                  const Rgba& paper) {
  Image image(view.width, view.height);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t(0));
  const float pixels = lettering_size(image);
  if (pixels <= 0) return image;
  const float thin = std::max(0.8f, 0.07f * pixels), dot = 3 * thin;
  const std::vector<Vec3d> points = parse_ruler(ruler);
  const std::vector<std::string> lines = ruler_lines(points, unit);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto here = pixel_of(view, points[k]);
    if (here) put_dot(image, *here, dot);
    const auto before = k > 0 ? pixel_of(view, points[k - 1]) : std::nullopt;
    if (!here || !before) continue;
    draw_stroke(image, float((*before)[0]), float((*before)[1]), thin, float((*here)[0]), float((*here)[1]), thin,
                mark_colour);
    put_text(image, {0.5 * ((*here)[0] + (*before)[0]), 0.5 * ((*here)[1] + (*before)[1])}, lines[k - 1], pixels,
             paper);
  }
  if (points.size() == 3)
    if (const auto corner = pixel_of(view, points[1])) put_text(image, *corner, lines.back(), pixels, paper);
  for (const PlacedNote& note : parse_notes(notes)) {
    const auto here = pixel_of(view, note.position);
    if (!here) continue;
    const std::array<double, 2> beside{(*here)[0] + 2 * pixels, (*here)[1] - 2 * pixels};
    draw_stroke(image, float(beside[0]), float(beside[1]), thin, float((*here)[0]), float((*here)[1]), thin,
                mark_colour);
    put_dot(image, *here, dot);
    put_text(image, beside, note.text, pixels, paper);
  }
  return image;
}

}  // namespace nacre
