// Nacre: stars found on a device. Those of the call before stay there.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compute/meshing/cut_star.hpp"
#include "compute/meshing/item_boxes.hpp"
#include "compute/meshing/list_items.hpp"
#include "compute/meshing/read_stars.hpp"
#include "compute/meshing/settle_stars.hpp"
#include "compute/meshing/star_device.hpp"

namespace nacre {

namespace detail {

/// Copies the stars that are still right, as far as their own neighbours tell; marks the others.
struct TakeStarsOver {
  const std::uint32_t* old_of;
  const std::uint32_t* new_of;
  const Star* before;
  Star* star;
  std::uint32_t* stale;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t old = old_of[i];
    stale[i] = old == none;
    if (old == none) return;
    Star& mine = star[i];
    mine = before[old];
    for (int k = 0; k < mine.count; ++k) {
      mine.ring[k] = new_of[mine.ring[k]];
      if (mine.ring[k] == none) stale[i] = 1;
    }
  }
};

struct ReachOfKnown {
  const std::uint32_t* old_of;
  const Star* star;
  NACRE_HD float operator()(std::int64_t i) const { return old_of[i] == none ? 0 : star[i].reach; }
};

struct LongerReach {
  NACRE_HD float operator()(float a, float b) const { return a < b ? b : a; }
};

/// Marks the stars that reach as far as where an item has come or gone.
struct MarkReaching {
  StarItemsView items;
  ItemBoxesView boxes;
  const ItemChange::Position* position;
  const std::uint32_t* old_of;
  const Star* star;
  double farthest2;
  std::uint32_t* stale;
  NACRE_HD void operator()(std::int64_t k) const {
    const std::uint32_t s = position[k].surface;
    const Vec3f at(position[k].at);
    boxes.within(items.first[s], items.first[s + 1], at, farthest2, [&](double d, std::uint32_t i) {
      if (old_of[i] == none) return;
      if (const double r = star[i].reach; d <= r * r) relaxed_store(stale + i, 1);
    });
  }
};

struct IsMarked {
  const std::uint32_t* mark;
  NACRE_HD std::int64_t operator()(std::int64_t i) const { return mark[i] != 0; }
};

}  // namespace detail

template <class Backend>
class DeviceStars : public StarDevice {
 public:
  /// Takes permanent memory, and gives it back in the end: what others take meanwhile they have to give back before.
  explicit DeviceStars(Executor<Backend>& exec) : exec_(exec), mark_(exec.arena().mark()) {}
  ~DeviceStars() override { exec_.arena().rewind(mark_); }
  DeviceStars(const DeviceStars&) = delete;
  DeviceStars& operator=(const DeviceStars&) = delete;

  void find(const StarParticles& particles, const TellChange& tell_change, FoundStars& found) override {
    Arena::Scope scope(exec_.arena());
    DeviceItems items(exec_.arena(), most_items(particles));
    StarItems now = list(items, particles);
    std::optional<ItemChange> change;
    if (has_room(now.count())) change = tell_change(now);
    if (now.count() > 0)
      find(items.view(copy_of(now.first)), std::int64_t(now.count()), change ? &*change : nullptr, found);
    else
      found = {};
    found.items = std::move(now);
  }

 private:
  static std::size_t most_items(const StarParticles& particles) {
    std::size_t most = 0;
    for (const Junction& j : particles.junction) most += std::size_t(j.materials() * (j.materials() - 1) / 2);
    return most;
  }

  StarItems list(DeviceItems& items, const StarParticles& particles) {
    if (particles.count() == 0) return {};
    Arena::Scope scope(exec_.arena());
    const auto n = std::int64_t(particles.count());
    const Junction* junction = copy_of(particles.junction);
    const auto gradients_before = exec_.arena().template temporary<std::uint32_t>(particles.count());
    exec_.for_each(n, detail::HasGradients{junction, gradients_before.data()});
    exec_.scan(gradients_before.data(), gradients_before.data(), n);
    return items.list(exec_,
                      {copy_of(particles.position), copy_of(particles.direction), junction, copy_of(particles.gradient),
                       gradients_before.data()},
                      n);
  }

  /// Finds the stars of `n` items, at least one.
  void find(const StarItemsView& items, std::int64_t n, const ItemChange* change, FoundStars& found) {
    const ItemBoxesView boxes = item_boxes(exec_, items, n);
    const auto stale = exec_.arena().template temporary<std::uint32_t>(std::size_t(n));
    if (change)
      take_over(items, boxes, *change, stale);
    else
      exec_.fill(stale, 1);
    const auto weight = exec_.arena().template temporary<double>(std::size_t(n));
    exec_.for_each(n, detail::WeighItems{items, weight.data()});
    exec_.for_each(detail::eighth(n), detail::CutStars{items, weight.data(), boxes, n, stale.data(), stars_.data()});
    StarSettling<Backend> settling(exec_, items, stars_, spare_, n);
    settling.settle(stale);
    found.stars.resize(std::size_t(n));
    exec_.device().copy_to_host(found.stars.data(), stars_.data(), found.stars.size() * sizeof(Star));
    read_stars(exec_, items, stars_.data(), n, found);
    settling.put_back();
    found.cut = exec_.reduce(n, std::int64_t(0), detail::IsMarked{stale.data()}, Add{});
  }

  /// False where there was not, and the stars of the call before are gone.
  bool has_room(std::size_t n) {
    if (stars_.size() >= n) return true;
    exec_.arena().rewind(mark_);
    for (Array<Star>* stars : {&stars_, &spare_}) *stars = exec_.arena().template permanent<Star>(n + n / 8);
    return false;
  }

  template <class T>
  const T* copy_of(std::span<const T> host) {
    auto array = exec_.arena().template temporary<T>(host.size());
    array.upload(host);
    return array.data();
  }
  template <class T>
  const T* copy_of(const std::vector<T>& host) {
    return copy_of(std::span<const T>(host));
  }

  void take_over(const StarItemsView& items, const ItemBoxesView& boxes, const ItemChange& change,
                 const Array<std::uint32_t>& stale) {
    Arena::Scope scope(exec_.arena());
    const auto n = std::int64_t(change.old_of.size());
    const std::uint32_t* old_of = copy_of(change.old_of);
    std::swap(stars_, spare_);
    exec_.for_each(n,
                   detail::TakeStarsOver{old_of, copy_of(change.new_of), spare_.data(), stars_.data(), stale.data()});
    const double farthest = exec_.reduce(n, 0.0f, detail::ReachOfKnown{old_of, stars_.data()}, detail::LongerReach{});
    exec_.for_each(std::int64_t(change.positions.size()),
                   detail::MarkReaching{items, boxes, copy_of(change.positions), old_of, stars_.data(),
                                        farthest * farthest, stale.data()});
  }

  Executor<Backend>& exec_;
  std::size_t mark_;
  Array<Star> stars_, spare_;  // as they were cut, with room for more
};

}  // namespace nacre
