// Nacre: time steps in files, of which each process reads what it has a share of.
#include "engine/io/shared_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "compute/device/among_all.hpp"
#include "compute/device/byte_hash.hpp"
#include "compute/device/error.hpp"
#include "engine/io/build_surface.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/reader.hpp"
#include "engine/io/registry.hpp"
#include "engine/io/same_points.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr double least_part = 0.1;  // of a share: less of a piece is left to the process that has the rest

bool is_piece_list(const fs::path& path) {
  const std::string extension = format_extension(path);
  return extension == "pvtp" || extension == "pvtu";
}

std::uint64_t polygons_of(const RawMesh& mesh) {
  const std::uint64_t hash = hash_of(hash_begin, std::span<const std::size_t>(mesh.offsets));
  return hash_of(hash, std::span<const std::uint32_t>(mesh.connectivity));
}

std::uint64_t points_of(const RawMesh& mesh) { return hash_of(hash_begin, std::span<const Vec3d>(mesh.points)); }

/// Appends a part to a share: of the arrays those that both have. A part without points does not decide which.
void append_part(Surface& share, Surface&& part) {
  if (part.points.empty()) return;
  if (share.points.empty()) {
    share = std::move(part);
    return;
  }
  const auto shift = std::uint32_t(share.points.size());
  std::erase_if(share.arrays, [&](PointArray& array) {
    const PointArray* other = part.find(array.name);
    if (!other || other->components != array.components) return true;
    array.values.insert(array.values.end(), other->values.begin(), other->values.end());
    return false;
  });
  share.points.insert(share.points.end(), part.points.begin(), part.points.end());
  for (const Triangle& t : part.triangles) share.triangles.push_back({t.a + shift, t.b + shift, t.c + shift});
}

/// The texts of all processes, in their order. Collective.
std::vector<std::string> texts_of_all(Ranks& ranks, const std::string& own) {
  ForEachRank<char> send(static_cast<std::size_t>(ranks.count()), std::vector<char>(own.begin(), own.end()));
  std::vector<std::string> texts;
  for (const std::vector<char>& from : exchange_items(ranks, send)) texts.emplace_back(from.begin(), from.end());
  return texts;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

}  // namespace

SharedFiles::SharedFiles(FileSteps files, Ranks& ranks) : ranks_(ranks), files_(std::move(files)) {
  require_same_files();
  divide();
  Surface share = load_first();
  agree_on_arrays(share);
  const std::size_t last = files_.steps.size() - 1;
  if (last > 0) {  // a cycle may end where it began, so the last step alone would not show that it moves
    bool moved = false;
    for (const std::size_t k : {std::size_t(1), last, (last + 1) / 2})
      if (!moved) load_later(k, moved);
    moves_ = sum_of_all(&ranks_, moved ? 1 : 0) > 0;
    return;
  }
  families_ = find_array_families(arrays_);
  warnings_.insert(warnings_.end(), families_.warnings.begin(), families_.warnings.end());
}

std::vector<double> SharedFiles::times() const {
  if (!families_.times.empty()) return families_.times;
  std::vector<double> times;
  for (const FileStep& step : files_.steps) times.push_back(step.time);
  return times;
}

std::vector<SharedFiles::Piece> SharedFiles::pieces_of(std::size_t step) const {
  std::vector<Piece> pieces;
  const FileStep& files = files_.steps[step];
  const auto size_of = [](const fs::path& file) { return std::max<std::uint64_t>(1, fs::file_size(file)); };
  const bool shapes = std::any_of(files.parts.begin(), files.parts.end(),
                                  [](const fs::path& part) { return format_extension(part) == "gii"; });
  if (shapes) return {{{}, files, 1}};
  for (const fs::path& part : files.parts) {
    if (!is_piece_list(part)) {
      require_file(part);
      pieces.push_back({{}, {files.time, {part}}, size_of(part)});
      continue;
    }
    for (VtkPiece& piece : vtk_pieces(part)) {
      if (!fs::is_regular_file(piece.file))
        throw Error(piece.file.string() + " cannot be opened",
                    "there is no such file, but " + part.string() + " names it", "put it there");
      const std::uint64_t size = size_of(piece.file);
      pieces.push_back({std::move(piece), {}, size});
    }
  }
  return pieces;
}

RawMesh SharedFiles::read(const Piece& piece) const {
  return piece.named.list_type.empty() ? read_step(piece.alone, files_.patches) : read_vtk_piece(piece.named);
}

/// By the names and sizes of all pieces. Missing ones are found before anything is read.
void SharedFiles::require_same_files() const {
  std::uint64_t hash = hash_begin;
  for (std::size_t k = 0; k < files_.steps.size(); ++k)
    for (const Piece& piece : pieces_of(k)) {
      const std::string name = fs::path(piece.name()).filename().string();
      const std::uint64_t numbers[] = {k, piece.size};
      hash = hash_of(hash_of(hash, std::span<const char>(name)), std::span<const std::uint64_t>(numbers));
    }
  require_same(ranks_, hash);
}

/// Cuts the pieces of the first step into shares of equal bytes. A border near that of a piece is moved there.
void SharedFiles::divide() {
  const std::vector<Piece> pieces = pieces_of(0);
  std::vector<double> end;
  double all = 0;
  for (const Piece& piece : pieces) end.push_back(all += double(piece.size));
  const double mean = all / ranks_.count();
  const auto border = [&](int r) {
    double at = mean * r;
    for (std::size_t p = 0; p + 1 < end.size(); ++p)
      if (std::fabs(end[p] - at) < least_part * mean) at = end[p];
    return r == 0 ? 0 : r == ranks_.count() ? all : at;
  };
  const double low = border(ranks_.rank()), high = border(ranks_.rank() + 1);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const double begin = end[p] - double(pieces[p].size);
    const double from = std::max(low, begin), to = std::min(high, end[p]);
    if (from < to)
      parts_.push_back({p, (from - begin) / double(pieces[p].size), (to - begin) / double(pieces[p].size)});
  }
}

Surface SharedFiles::cut(const Part& part, const Surface& whole, std::vector<std::uint32_t>& used) const {
  const auto n = double(whole.triangles.size());
  return cut_share(whole, std::size_t(n * part.from), std::size_t(n * part.to), used);
}

Surface SharedFiles::load_first() {
  const std::vector<Piece> pieces = pieces_of(0);
  std::vector<std::string> warnings;
  Vec3d low(1e300), high(-1e300);
  std::uint64_t volume_cells = 0;
  Surface share;
  for (const Part& part : parts_) {
    RawMesh mesh = read(pieces[part.piece]);
    volume_cells += mesh.volume_cells;
    for (const Vec3d& p : mesh.points)
      if (is_finite(p)) low = min(low, p), high = max(high, p);
    Print& print = prints_.emplace_back(Print{polygons_of(mesh), points_of(mesh)});
    const Surface whole = build_surface(std::move(mesh), pieces[part.piece].name(), warnings, nullptr, true);
    print.triangles = whole.triangles.size();
    std::vector<std::uint32_t> used;
    append_part(share, cut(part, whole, used));
    for (const std::uint32_t p : used) point_id_.push_back(std::uint64_t(part.piece) << 32 | p);
  }
  require_same_pieces();
  extremes_of_all(&ranks_, {&low.x, 3}, {&high.x, 3});
  size_ = low.x <= high.x ? length(high - low) : 0;
  if (sum_of_all(&ranks_, volume_cells) > 0 && pieces.size() > 1) warnings.push_back(faces_between_pieces);
  gather_warnings(warnings);
  return share;
}

/// Processes that read the same piece have read the same.
void SharedFiles::require_same_pieces() const {
  struct PiecePrint {
    std::uint64_t piece, polygons, points;
  };
  std::vector<PiecePrint> own;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    own.push_back({parts_[i].piece, prints_[i].polygons, prints_[i].points});
  ForEachRank<PiecePrint> send(static_cast<std::size_t>(ranks_.count()), own);
  std::vector<PiecePrint> seen(pieces_of(0).size());
  std::uint64_t hash = 0;
  for (const std::vector<PiecePrint>& from : exchange_items(ranks_, send))
    for (const PiecePrint& each : from) {
      PiecePrint& first = seen[each.piece];
      if (first.polygons == 0) first = each;
      if (each.polygons != first.polygons || each.points != first.points) hash = 1 + std::uint64_t(ranks_.rank());
    }
  require_same(ranks_, hash);
}

/// Each sentence once.
void SharedFiles::gather_warnings(const std::vector<std::string>& own) {
  std::string text;
  for (const std::string& warning : own) text += warning + '\n';
  warnings_ = files_.warnings;
  for (const std::string& theirs : texts_of_all(ranks_, text))
    for (const std::string& line : lines_of(theirs))
      if (std::find(warnings_.begin(), warnings_.end(), line) == warnings_.end()) warnings_.push_back(line);
}

/// Those of the first process that has points, as far as all others that have some have them, too.
void SharedFiles::agree_on_arrays(Surface& share) {
  std::string own = share.points.empty() ? "" : "points\n";
  for (const PointArray& array : share.arrays)
    if (!share.points.empty()) own += fmt::format("{} {}\n", array.components, array.name);
  bool first = true;
  for (const std::string& text : texts_of_all(ranks_, own)) {
    if (text.empty()) continue;
    std::vector<PointArray> theirs;
    for (const std::string& line : lines_of(text)) {
      const std::size_t space = line.find(' ');
      if (space != line.npos) theirs.push_back({line.substr(space + 1), std::stoi(line), {}});
    }
    if (std::exchange(first, false)) {
      arrays_ = std::move(theirs);
      continue;
    }
    std::erase_if(arrays_, [&](const PointArray& array) {
      return std::none_of(theirs.begin(), theirs.end(), [&](const PointArray& other) {
        return other.name == array.name && other.components == array.components;
      });
    });
  }
  only_agreed(share);
}

void SharedFiles::only_agreed(Surface& share) const {
  std::vector<PointArray> kept;
  for (const PointArray& agreed : arrays_) {
    PointArray& array = kept.emplace_back(agreed);
    for (PointArray& own : share.arrays)
      if (own.name == agreed.name) array = std::move(own);
  }
  share.arrays = std::move(kept);
}

Surface SharedFiles::load(std::size_t k) const {
  bool moved = false;
  const std::size_t file = families_.times.empty() ? k : 0;
  Surface share = load_later(file, moved);
  if (moved && !moves_)
    throw Error(files_.steps[file].parts.front().string() + " does not fit the first step",
                "its points or triangles differ from those of " + files_.steps[0].parts.front().string() +
                    ", which those of other steps do not",
                "check whether it belongs to the series");
  if (!families_.times.empty()) select_step(share, families_, k);
  return share;
}

Surface SharedFiles::load_later(std::size_t k, bool& moved) const {
  const std::vector<Piece> first = pieces_of(0), pieces = k == 0 ? first : pieces_of(k);
  Surface share;
  moved = pieces.size() != first.size();
  if (moved) return share;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    bool other = false;
    const Surface whole = build_like_first(first[part.piece], prints_[i], read(pieces[part.piece]), other);
    moved = moved || other;
    if (other) continue;
    std::vector<std::uint32_t> used;
    append_part(share, cut(part, whole, used));
  }
  if (k == 0 || share.points.empty()) {
    only_agreed(share);
    return share;
  }
  std::erase_if(share.arrays, [&](const PointArray& array) {
    return std::none_of(arrays_.begin(), arrays_.end(),
                        [&](const PointArray& agreed) { return agreed.name == array.name; });
  });
  return share;
}

/// With the points of the first step, polygons are also triangulated as in the first step.
Surface SharedFiles::build_like_first(const Piece& first, const Print& print, RawMesh mesh, bool& moved) const {
  std::vector<std::string> warnings;
  if (polygons_of(mesh) != print.polygons) {
    moved = true;
    return {};
  }
  if (points_of(mesh) != print.points) {
    std::vector<Vec3d> points = read(first).points;
    moved = points.size() != mesh.points.size() || differ(points, mesh.points, size_);
    if (moved) return {};
    mesh.points = std::move(points);
  }
  return build_surface(std::move(mesh), first.name(), warnings, nullptr, true);
}

SharedSeries open_surface(const std::vector<fs::path>& paths, const std::string& patches, Ranks& ranks) {
  if (paths.empty()) throw Error("no file to open", "", "name at least one file");
  for (const fs::path& path : paths) require_file(path);
  const auto files = std::make_shared<const SharedFiles>(find_steps(paths, patches), ranks);
  SharedSeries shared;
  shared.series = {paths[0].filename().string(), files->times(), [files](std::size_t k) { return files->load(k); },
                   files->warnings(), files->moves()};
  shared.point_id = files->point_id();
  return shared;
}

}  // namespace nacre
