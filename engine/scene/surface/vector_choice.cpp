// Nacre: which array of a surface to show as vectors.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <span>

#include "compute/device/among_all.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/surface/surface_share.hpp"

namespace nacre {
namespace {

constexpr const char* analytic_advice = "name one with --vectors, or show an analytic field: --vectors @swirl";

std::string lower_case(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The words of a name, lower case: "wallShearStress_0" -> wall, shear, stress; "UMean" -> u, mean.
std::set<std::string> words_of(const std::string& name) {
  const auto is = [&](std::size_t i, auto test) {
    return i < name.size() && test(static_cast<unsigned char>(name[i]));
  };
  const auto upper = [](int c) { return std::isupper(c) != 0; };
  const auto lower = [](int c) { return std::islower(c) != 0; };
  const auto letter = [](int c) { return std::isalpha(c) != 0; };
  std::set<std::string> words;
  std::string word;
  for (std::size_t i = 0; i <= name.size(); ++i) {
    const bool capital = i > 0 && is(i, upper) && (is(i - 1, lower) || (is(i - 1, upper) && is(i + 1, lower)));
    if ((!is(i, letter) || capital) && !word.empty()) {
      words.insert(lower_case(word));
      word.clear();
    }
    if (is(i, letter)) word += name[i];
  }
  return words;
}

enum class Kind { never, displacement, other, momentum, velocity, wall_shear };

/// What a name says about an array. Fragments match anywhere, words only as a whole.
Kind kind_of(const std::string& name) {
  struct Rule {
    Kind kind;
    std::vector<std::string> fragments, words;
  };
  static const std::array<Rule, 5> rules = {{
      {Kind::wall_shear, {"shear", "skinfriction", "skin_friction", "traction"}, {"wss", "tau", "tauw"}},
      {Kind::velocity, {"veloc"}, {"vel", "u", "v", "uvw", "wind"}},
      {Kind::momentum, {"momentum"}, {"rhou", "rhov", "flux", "flow"}},
      {Kind::displacement, {"displ", "deform"}, {"disp"}},
      {Kind::never,
       {"texture", "texcoord", "tcoord", "color", "colour", "coordinate"},
       {"normal", "normals", "rgb", "uv", "coord", "coords", "point", "points", "position", "positions", "xyz"}},
  }};
  const std::string lower = lower_case(name);
  const std::set<std::string> words = words_of(name);
  for (const Rule& rule : rules) {
    const auto in_name = [&](const std::string& f) { return lower.find(f) != std::string::npos; };
    const auto is_word = [&](const std::string& w) { return words.count(w) > 0; };
    if (std::any_of(rule.fragments.begin(), rule.fragments.end(), in_name) ||
        std::any_of(rule.words.begin(), rule.words.end(), is_word))
      return rule.kind;
  }
  return Kind::other;
}

/// What an array's values say, measured against the triangles' own normals (so winding does not matter).
struct Content {
  double normal_share = 0;
  double zero_share = 0;
  bool unit_length = false;
};

Vec3d vector_at(const PointArray& array, std::size_t point) {
  const float* v = array.values.data() + 3 * point;
  const Vec3d result(v[0], v[1], v[2]);
  return is_finite(result) ? result : Vec3d{};
}

Content content_of(const Surface& surface, const PointArray& array, const Share* share) {
  Ranks* ranks = share ? share->ranks : nullptr;
  ExactSum normal, all;
  for (const Triangle& t : surface.triangles) {
    if (std::max({t.a, t.b, t.c}) >= std::min(array.size(), surface.points.size())) continue;
    const Vec3d a = surface.points[t.a];
    const Vec3d n = cross(surface.points[t.b] - a, surface.points[t.c] - a);
    const double area = length(n);
    if (!(area > 0) || !std::isfinite(area)) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3d v = vector_at(array, t[k]);
      normal.add(std::abs(dot(v, n)));
      all.add(length(v) * area);
    }
  }
  Content content;
  std::uint64_t zero = 0, unit = 0, items = 0;
  for (std::size_t p = 0; p < array.size(); ++p) {
    if (!is_counted(share, p)) continue;
    const double size = length(vector_at(array, p));
    ++items;
    zero += size == 0;
    unit += std::abs(size - 1) < 1e-3;
  }
  sum_of_all(ranks, normal);
  sum_of_all(ranks, all);
  zero = sum_of_all(ranks, zero);
  unit = sum_of_all(ranks, unit);
  items = sum_of_all(ranks, items);
  content.zero_share = items > 0 ? double(zero) / double(items) : 1.0;
  content.unit_length = items > 0 && unit == items;
  content.normal_share = all.value() > 0 ? normal.value() / all.value() : 0.0;
  return content;
}

struct Candidate {
  const PointArray* array;
  Kind kind;
  Content content;

  /// The kind of name counts first, but for fields with nothing to show; then what is not zero and not normal.
  double score() const {
    if (content.zero_share == 1) return -1;
    double score = double(static_cast<int>(kind)) - content.zero_share;
    if (content.normal_share > 0.8) score -= 3;
    return score;
  }
};

std::vector<Candidate> candidates(const Surface& surface, const Share* share) {
  std::vector<Candidate> result;
  for (const PointArray& array : surface.arrays) {
    if (array.components != 3 || kind_of(array.name) == Kind::never) continue;
    const Candidate candidate{&array, kind_of(array.name), content_of(surface, array, share)};
    const bool normals =
        candidate.kind == Kind::other && candidate.content.unit_length && candidate.content.normal_share > 0.9;
    if (!normals) result.push_back(candidate);
  }
  return result;
}

std::string list_arrays(const Surface& surface) {
  if (surface.arrays.empty()) return "it has no point arrays";
  std::vector<std::string> names;
  for (const PointArray& array : surface.arrays)
    names.push_back(array.components == 1 ? array.name : fmt::format("{} [{}]", array.name, array.components));
  return fmt::format("its point arrays are {}", fmt::join(names, ", "));
}

VectorChoice choose_analytic(const std::string& request) {
  const std::vector<std::string> names = analytic_vector_names();
  if (std::find(names.begin(), names.end(), request) == names.end())
    throw Error("there is no analytic field " + request, "",
                fmt::format("the fields are {}", fmt::join(names, " and ")));
  return {request, "an analytic field, as requested"};
}

VectorChoice choose_named(const Surface& surface, const std::string& request) {
  const PointArray* found = surface.find(request);
  std::string reason = "as requested";
  if (!found) {
    std::vector<const PointArray*> alike;
    for (const PointArray& array : surface.arrays)
      if (lower_case(array.name) == lower_case(request)) alike.push_back(&array);
    if (alike.size() != 1)
      throw Error(fmt::format("the surface has no array \"{}\"", request), list_arrays(surface), analytic_advice);
    found = alike[0];
    reason = fmt::format("as requested (\"{}\")", request);
  }
  if (found->components != 3)
    throw Error(fmt::format("the array \"{}\" has {} component{}, vectors have 3", found->name, found->components,
                            found->components == 1 ? "" : "s"),
                list_arrays(surface), analytic_advice);
  return {found->name, reason};
}

std::string describe(const Candidate& best, const std::vector<Candidate>& all) {
  if (all.size() == 1)
    return best.kind == Kind::displacement ? "the only vector array, though a displacement" : "the only vector array";
  static constexpr const char* kinds[] = {"", "a displacement", "vectors", "a momentum", "a velocity", "a wall shear"};
  std::vector<std::string> others;
  for (const Candidate& c : all)
    if (c.array != best.array) others.push_back(c.array->name);
  const std::size_t more = others.size() > 4 ? others.size() - 4 : 0;
  others.resize(others.size() - more);
  return fmt::format("the most likely of {} vector arrays: {} by name; others: {}{}", all.size(),
                     kinds[static_cast<int>(best.kind)], fmt::join(others, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

}  // namespace

VectorKind vector_kind(const std::string& name) {
  const Kind kind = kind_of(name);
  return kind == Kind::wall_shear ? VectorKind::wall_shear
         : kind == Kind::velocity ? VectorKind::velocity
                                  : VectorKind::other;
}

VectorChoice choose_vectors(const Surface& surface, const std::string& request, const Share* share) {
  if (!request.empty()) return request[0] == '@' ? choose_analytic(request) : choose_named(surface, request);
  const std::vector<Candidate> all = candidates(surface, share);
  if (all.empty()) throw Error("the surface has no vectors to show", list_arrays(surface), analytic_advice);
  const auto best = std::max_element(all.begin(), all.end(),
                                     [](const Candidate& a, const Candidate& b) { return a.score() < b.score(); });
  return {best->array->name, describe(*best, all)};
}

}  // namespace nacre
