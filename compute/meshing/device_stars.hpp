// Nacre: stars found on a device. Those of the call before stay there.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "compute/meshing/cut_star.hpp"
#include "compute/meshing/item_boxes.hpp"
#include "compute/meshing/known_items.hpp"
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
  StarItemsView changed_items;       // the same, or those before
  const std::uint32_t* new_surface;  // of theirs; null: the same
  const std::uint32_t* changed;
  const std::uint32_t* old_of;
  const Star* star;
  double farthest2;
  std::uint32_t* stale;
  NACRE_HD void operator()(std::int64_t k) const {
    const std::uint32_t surface = changed_items.surface[changed[k]], s = new_surface ? new_surface[surface] : surface;
    if (s == none) return;
    const Vec3f at(changed_items.position[changed[k]]);
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

  FoundStars& find(const StarParticles& particles) override {
    Arena::Scope scope(exec_.arena());
    put_back();
    make_room(most_items(particles));
    std::swap(items_, before_);
    list(particles);
    found_ = {};
    found_.items = items_.seen_by_host();
    if (items_.count() > 0) find(items_.view(copy_of(items_.first())), std::int64_t(items_.count()));
    return found_;
  }

 private:
  static constexpr std::size_t dear_share = 4;  // where more than this part has changed, finding all again costs less

  static std::size_t most_items(const StarParticles& particles) {
    std::size_t most = 0;
    for (const Junction& j : particles.junction) most += std::size_t(j.materials() * (j.materials() - 1) / 2);
    return most;
  }

  /// Where there is not enough, what is known of the call before is gone.
  void make_room(std::size_t n) {
    if (items_.room() >= n) return;
    Arena& arena = exec_.arena();
    arena.rewind(mark_);
    for (DeviceItems* items : {&items_, &before_}) *items = DeviceItems(arena, n + n / 8);
    for (Array<Star>* stars : {&stars_, &spare_}) *stars = arena.template permanent<Star>(n + n / 8);
    settled_ = arena.template permanent<std::uint32_t>(n + n / 8);
  }

  /// Makes stars what they were before they settled.
  void put_back() {
    exec_.for_each(std::exchange(changed_, 0), detail::PutBackStars{settled_.data(), spare_.data(), stars_.data()});
  }

  void list(const StarParticles& particles) {
    Arena::Scope scope(exec_.arena());
    const auto n = std::int64_t(particles.count());
    const Junction* junction = copy_of(particles.junction);
    const auto gradients_before = exec_.arena().template temporary<std::uint32_t>(particles.count());
    if (n > 0) {
      exec_.for_each(n, detail::HasGradients{junction, gradients_before.data()});
      exec_.scan(gradients_before.data(), gradients_before.data(), n);
    }
    items_.list(exec_,
                {copy_of(particles.position), copy_of(particles.direction), junction, copy_of(particles.gradient),
                 gradients_before.data()},
                n);
  }

  /// Finds the stars of `n` items, at least one.
  void find(const StarItemsView& items, std::int64_t n) {
    const ItemBoxesView boxes = item_boxes(exec_, items, n);
    const auto stale = exec_.arena().template temporary<std::uint32_t>(std::size_t(n));
    if (!take_over(items, boxes, stale)) exec_.fill(stale, 1);
    const auto weight = exec_.arena().template temporary<double>(std::size_t(n));
    exec_.for_each(n, detail::WeighItems{items, weight.data()});
    exec_.for_each(detail::eighth(n), detail::CutStars{items, weight.data(), boxes, n, stale.data(), stars_.data()});
    StarSettling<Backend> settling(exec_, items, stars_, spare_, settled_, n);
    settling.settle(stale);
    changed_ = settling.changed();
    found_.stars = stars_.seen_by_host(std::size_t(n), copy_);
    read_stars(exec_, items, items_.materials(), stars_.data(), n, found_);
    found_.cut = exec_.reduce(n, std::int64_t(0), detail::IsMarked{stale.data()}, Add{});
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

  /// Takes the stars over that are right still, and marks the others; false where so much has changed that finding all
  /// again costs less.
  bool take_over(const StarItemsView& items, const ItemBoxesView& boxes, const Array<std::uint32_t>& stale) {
    if (before_.count() == 0) return false;
    Arena::Scope scope(exec_.arena());
    const auto n = std::int64_t(items_.count());
    const ItemChange change = item_change(exec_, before_, stars_.data(), items_);
    if (change.come.size() + change.gone.size() > items_.count() / dear_share) return false;
    const std::uint32_t* old_of = change.old_of.data();
    std::swap(stars_, spare_);
    exec_.for_each(n, detail::TakeStarsOver{old_of, change.new_of.data(), spare_.data(), stars_.data(), stale.data()});
    const float farthest = exec_.reduce(n, 0.0f, detail::ReachOfKnown{old_of, stars_.data()}, detail::LongerReach{});
    const auto mark_reaching = [&](const StarItemsView& of, const std::uint32_t* new_surface,
                                   const Array<std::uint32_t>& changed) {
      exec_.for_each(std::int64_t(changed.size()),
                     detail::MarkReaching{items, boxes, of, new_surface, changed.data(), old_of, stars_.data(),
                                          double(farthest) * farthest, stale.data()});
    };
    mark_reaching(items, nullptr, change.come);
    mark_reaching(before_.view(nullptr), change.new_surface.data(), change.gone);
    return true;
  }

  Executor<Backend>& exec_;
  std::size_t mark_;
  DeviceItems items_, before_;
  Array<Star> stars_;             // of `items_`, settled; with room for more
  Array<Star> spare_;             // those that changed then, as they were cut
  Array<std::uint32_t> settled_;  // which these are,
  std::int64_t changed_ = 0;      // and how many
  std::vector<Star> copy_;        // for a host that does not share the memory
  FoundStars found_;
};

}  // namespace nacre
