// Nacre: changes the points around bad triangles, and undoes the change where it did not help.
#include "compute/meshing/attempt.hpp"

#include <algorithm>
#include <numeric>

namespace nacre {

Attempt::Attempt(std::size_t points, const View& before, std::span<const std::uint8_t> bad, const DefectRule& rule)
    : rule_(rule), patch_before_(points, none), now_of_(points) {
  const Patches patches = patches_around(before.mesh, bad);
  for (std::size_t v = 0; v < before.point_of.size(); ++v) patch_before_[before.point_of[v]] = patches.of[v];
  std::iota(now_of_.begin(), now_of_.end(), 0u);
  patch_ = patch_before_;
  fitness_before_ = fitness_ =
      patch_fitness(before.mesh, before.order, rule, before.touching, patches.of, patches.count);
}

void Attempt::change(std::span<const std::uint8_t> gone, std::size_t points) {
  std::vector<std::uint32_t> number(gone.size(), none);
  std::uint32_t stay = 0;
  for (std::size_t i = 0; i < gone.size(); ++i) {
    if (gone[i]) continue;
    patch_[stay] = patch_[i];
    number[i] = stay++;
  }
  patch_.resize(stay);
  patch_.resize(points, none);
  for (std::uint32_t& k : now_of_)
    if (k != none) k = number[k];
}

void Attempt::judge(const View& now) {
  const std::size_t stayed = patch_before_.size() - std::size_t(std::count(now_of_.begin(), now_of_.end(), none));
  std::vector<std::uint32_t> patch_of;
  std::vector<std::uint8_t> is_new;
  for (const std::uint32_t i : now.point_of) {
    patch_of.push_back(patch_[i]);
    is_new.push_back(i >= stayed);
  }
  join_patches(now.mesh, is_new, patch_of);
  for (std::size_t v = 0; v < patch_of.size(); ++v) patch_[now.point_of[v]] = patch_of[v];
  fitness_ = patch_fitness(now.mesh, now.order, rule_, now.touching, patch_of, std::uint32_t(fitness_before_.size()));
}

std::vector<std::uint8_t> Attempt::open(const View& now) const {
  std::vector<std::uint8_t> open;
  for (const std::uint32_t i : now.point_of)
    open.push_back(patch_[i] != none && fitness_before_[patch_[i]] < 1 && worse(patch_[i]));
  if (std::find(open.begin(), open.end(), 1) == open.end()) open.clear();
  return open;
}

std::vector<Attempt::Source> Attempt::taken_back() const {
  std::vector<Source> mixed;
  bool any = false;
  std::uint32_t fresh = 0;
  for (std::uint32_t i = 0; i < patch_before_.size(); ++i) {
    if (worse(patch_before_[i]))
      mixed.push_back({true, i}), any = true;
    else if (now_of_[i] != none)
      mixed.push_back({false, now_of_[i]});
    fresh += now_of_[i] != none;
  }
  if (!any) return {};
  for (; fresh < patch_.size(); ++fresh)
    if (!worse(patch_[fresh])) mixed.push_back({false, fresh});
  return mixed;
}

}  // namespace nacre
