// Nacre: stars compared with each other: what they agree on, and rounds in which they settle.
#pragma once

#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/meshing/settle_star.hpp"

namespace nacre {

namespace detail {

/// Items in any order, put there by many threads.
struct ItemList {
  std::uint32_t* item;
  std::uint32_t* count;
  NACRE_HD std::uint32_t add(std::uint32_t i) const {
    const std::uint32_t at = atomic_add(count, std::uint32_t(1));
    item[at] = i;
    return at;
  }
};

/// Stars as they were before they were changed for the first time.
struct StarJournal {
  std::uint32_t* kept;  // per item, 0 at first
  Star* before;         // as listed
  ItemList items;
  NACRE_HD void keep(std::uint32_t i, const Star& star) const {
    if (kept[i]) return;
    kept[i] = 1;
    before[items.add(i)] = star;
  }
};

/// What a star agrees on with its neighbours is the same unless one of them has changed.
struct AgreeStars {
  const std::uint32_t* changed;
  Star* star;
  ItemList open;
  NACRE_HD void operator()(std::int64_t i) const {
    Star& mine = star[i];
    bool differs = changed[i];
    for (int k = 0; k < mine.count && !differs; ++k) differs = changed[mine.ring[k]];
    if (differs) mine.agreed = agreed_on(star, std::uint32_t(i), mine);
    if (mine.has_open()) open.add(std::uint32_t(i));
  }
};

/// Decides what open stars change; all read what the others were before.
struct DecideChanges {
  StarItemsView items;
  const Star* star;
  const std::uint32_t* open;
  const std::uint32_t* changed_at;  // per item: the round before which it has changed last
  std::uint32_t round;
  Star* to;          // per open star
  ItemList changes;  // of the open ones
  NACRE_HD void operator()(std::int64_t k) const {
    const std::uint32_t i = open[k];
    const Star& mine = star[i];
    // A star that sees nothing new decides as it did.
    bool asks = changed_at[i] == round;
    for (int r = 0; r < mine.count && !asks; ++r) asks = changed_at[mine.ring[r]] == round;
    if (asks && StarSettler(items, star, i).run(to[k])) changes.add(std::uint32_t(k));
  }
};

/// Lists each item once.
struct TouchedItems {
  std::uint32_t* touched;  // per item, 0 at first
  ItemList items;
  NACRE_HD void add(std::uint32_t i) const {
    if (atomic_add(touched + i, std::uint32_t(1)) == 0) items.add(i);
  }
  NACRE_HD void add_ring(const Star& star) const {
    for (int k = 0; k < star.count; ++k) add(star.ring[k]);
  }
};

struct TouchOpen {
  const std::uint32_t* open;
  TouchedItems touched;
  NACRE_HD void operator()(std::int64_t k) const { touched.add(open[k]); }
};

struct ApplyChanges {
  const std::uint32_t* open;
  const std::uint32_t* change;
  const Star* to;
  std::uint32_t round;
  Star* star;
  std::uint32_t* changed_at;
  TouchedItems touched;
  StarJournal journal;
  NACRE_HD void operator()(std::int64_t c) const {
    const std::uint32_t k = change[c], i = open[k];
    touched.add_ring(star[i]), touched.add_ring(to[k]);
    journal.keep(i, star[i]);
    star[i] = to[k];
    changed_at[i] = round + 1;
  }
};

struct AgreeTouched {
  TouchedItems touched;
  Star* star;
  StarJournal journal;
  ItemList open;
  NACRE_HD void operator()(std::int64_t k) const {
    const std::uint32_t i = touched.items.item[k];
    touched.touched[i] = 0;
    const std::uint32_t agreed = agreed_on(star, i, star[i]);
    if (agreed != star[i].agreed) {
      journal.keep(i, star[i]);
      star[i].agreed = agreed;
    }
    if (star[i].has_open()) open.add(i);
  }
};

struct PutBackStars {
  const std::uint32_t* item;
  const Star* before;
  Star* star;
  NACRE_HD void operator()(std::int64_t k) const { star[item[k]] = before[k]; }
};

}  // namespace detail

/// Marks in `stars` what all corners of their triangles agree on, and settles those that have other triangles: where
/// two lay different ones on an edge, each of the four corners takes the diagonal of the rule, in several rounds, in
/// each of which every star reads what all were before. The answer does not depend on the order that threads come in.
template <class Backend>
class StarSettling {
 public:
  /// `n` items at least one; memory is temporary, of the caller's scope. `before` and `kept` have room for all stars:
  /// they receive those that change, as they were, and which these are.
  StarSettling(Executor<Backend>& exec, const StarItemsView& items, const Array<Star>& stars, const Array<Star>& before,
               const Array<std::uint32_t>& kept, std::int64_t n)
      : exec_(exec),
        items_(items),
        stars_(stars),
        before_(before),
        n_(n),
        open_(list()),
        next_open_(list()),
        touched_(list()),
        kept_(kept),
        is_touched_(list()),
        is_kept_(list()),
        changed_at_(list()),
        counts_(exec.arena().template temporary<std::uint32_t>(counters)) {
    for (const auto& marks : {is_touched_, is_kept_, changed_at_}) exec_.fill(marks, 0);
    exec_.fill(counts_, 0);
  }

  /// `changed` marks the stars that have no `agreed` yet.
  void settle(const Array<std::uint32_t>& changed) {
    exec_.for_each(n_, detail::AgreeStars{changed.data(), stars_.data(), {open_.data(), count(open)}});
    for (std::uint32_t round = 0; round < rounds; ++round) {
      const std::int64_t some = read(open);
      if (some == 0 || !settle_once(some, round)) return;
    }
  }

  /// How many stars have changed.
  std::int64_t changed() const { return read(kept); }

 private:
  static constexpr std::uint32_t rounds = 6;
  enum Counter { open, changes, touched, kept, counters };

  Array<std::uint32_t> list() const { return exec_.arena().template temporary<std::uint32_t>(std::size_t(n_)); }
  std::uint32_t* count(Counter which) const { return counts_.data() + which; }
  std::int64_t read(Counter which) const { return counts_.download(which, 1)[0]; }
  void reset(Counter which) { exec_.device().fill(count(which), 0, sizeof(std::uint32_t)); }

  /// False where nothing changes.
  bool settle_once(std::int64_t some, std::uint32_t round) {
    Arena::Scope scope(exec_.arena());
    const auto to = exec_.arena().template temporary<Star>(std::size_t(some));
    const auto change = exec_.arena().template temporary<std::uint32_t>(std::size_t(some));
    reset(changes), reset(touched);
    exec_.for_each(some, detail::DecideChanges{items_,
                                               stars_.data(),
                                               open_.data(),
                                               changed_at_.data(),
                                               round,
                                               to.data(),
                                               {change.data(), count(changes)}});
    const std::int64_t changing = read(changes);
    if (changing == 0) return false;
    const detail::TouchedItems touching{is_touched_.data(), {touched_.data(), count(touched)}};
    const detail::StarJournal journal{is_kept_.data(), before_.data(), {kept_.data(), count(kept)}};
    exec_.for_each(some, detail::TouchOpen{open_.data(), touching});
    exec_.for_each(changing, detail::ApplyChanges{open_.data(), change.data(), to.data(), round, stars_.data(),
                                                  changed_at_.data(), touching, journal});
    reset(open);
    exec_.for_each(read(touched),
                   detail::AgreeTouched{touching, stars_.data(), journal, {next_open_.data(), count(open)}});
    std::swap(open_, next_open_);
    return true;
  }

  Executor<Backend>& exec_;
  StarItemsView items_;
  Array<Star> stars_, before_;
  std::int64_t n_;
  Array<std::uint32_t> open_, next_open_, touched_, kept_;  // lists,
  Array<std::uint32_t> is_touched_, is_kept_, changed_at_;  // and marks
  Array<std::uint32_t> counts_;                             // how long lists are
};

}  // namespace nacre
