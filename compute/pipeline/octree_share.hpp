// Nacre: the bricks of the octree that one of several processes has, and what it exchanges with the others.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "compute/device/error.hpp"
#include "compute/device/ranks.hpp"
#include "compute/embedding/build_brick_octree.hpp"
#include "compute/flow/halo_depths.hpp"
#include "compute/pipeline/flow_domain.hpp"
#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

/// Where each process's range of Morton codes of bricks begins, and the end of the last: ranges of about equal work,
/// the same on all processes, which look at a part of the triangles each. Collective.
std::vector<std::uint64_t> cut_octree(Ranks& ranks, const FlowMesh& mesh, const FlowDomain& domain, int levels);

namespace detail {

/// Copies the surface cells of bricks into a row, brick after brick, or back. A row may hold several `arrays`, those of
/// a brick one after the other; this is number `which`.
template <class Value>
struct PackBricks {
  const OctreeBrick* brick;
  const std::uint32_t* listed;
  const std::uint64_t* start;  // of each listed brick in the row
  const Value* value;
  Value* row;
  int arrays = 1, which = 0;
  NACRE_HD void operator()(std::int64_t i) const {
    const CellMask& mask = brick[listed[i]].surface;
    const int n = mask.count();
    Value* to = row + arrays * start[i] + which * n;
    for (int k = 0; k < n; ++k) to[k] = value[mask.first + CellIndex(k)];
  }
};

template <class Value>
struct UnpackBricks {
  const OctreeBrick* brick;
  const std::uint32_t* listed;
  const std::uint64_t* start;
  const Value* row;
  Value* value;
  NACRE_HD void operator()(std::int64_t i) const {
    const CellMask& mask = brick[listed[i]].surface;
    const int n = mask.count();
    for (int k = 0; k < n; ++k) value[mask.first + CellIndex(k)] = row[start[i] + std::uint64_t(k)];
  }
};

/// Sets the surface cells of bricks to 0.
struct ClearBricks {
  const OctreeBrick* brick;
  const std::uint32_t* listed;
  std::uint64_t* value;
  NACRE_HD void operator()(std::int64_t i) const {
    const CellMask& mask = brick[listed[i]].surface;
    const int n = mask.count();
    for (int k = 0; k < n; ++k) value[mask.first + CellIndex(k)] = 0;
  }
};

/// Adds a row to the surface cells of bricks, of which two may be the same one; `arrays` and `which` as above.
struct AddToBricks {
  const OctreeBrick* brick;
  const std::uint32_t* listed;
  const std::uint64_t* start;
  const std::uint64_t* row;
  std::uint64_t* value;
  int arrays = 1, which = 0;
  NACRE_HD void operator()(std::int64_t i) const {
    const CellMask& mask = brick[listed[i]].surface;
    const int n = mask.count();
    const std::uint64_t* from = row + arrays * start[i] + which * n;
    for (int k = 0; k < n; ++k)
      if (from[k] != 0) atomic_add(value + mask.first + k, from[k]);
  }
};

}  // namespace detail

/// The share of this process: its own bricks, and a halo of bricks of others that are within some depth of them. The
/// cells of its octree are numbered on their own; what goes from one process to another goes brick by brick, in the
/// order of Morton codes, in which both have them.
template <class Backend>
class OctreeShare {
 public:
  /// `begin`: what cut_octree gives. The arrays of the share are permanent.
  OctreeShare(Executor<Backend>& exec, Ranks& ranks, std::vector<std::uint64_t> begin, const HaloDepths& depths)
      : exec_(exec), ranks_(ranks), begin_(std::move(begin)), depths_(depths) {}

  Ranks& ranks() const { return ranks_; }
  OctreePart part() const { return {begin_[at(ranks_.rank())], begin_[at(ranks_.rank()) + 1], depths_.whole}; }

  /// Takes up the octree of `part`, and finds with the other processes what goes to whom. Collective.
  void take(const BrickOctree& tree) {
    code_ = tree.brick_code.download();
    brick_ = tree.brick.data();
    const std::vector<OctreeBrick> bricks = tree.brick.download();
    const OctreePart own = part();
    own_first_ = std::size_t(std::lower_bound(code_.begin(), code_.end(), own.first) - code_.begin());
    own_count_ = std::size_t(std::lower_bound(code_.begin(), code_.end(), own.last) - code_.begin()) - own_first_;
    surface_first_ = own_count_ ? bricks[own_first_].surface.first : 0;
    for (std::size_t b = own_first_; b < own_first_ + own_count_; ++b) {
      surface_count_ += detail::cells_of(bricks[b].surface);
      cells_ += detail::cells_of(bricks[b].band);
    }
    std::vector<std::uint32_t> chosen;
    for (std::size_t b = own_first_; b < own_first_ + own_count_; ++b) chosen.push_back(std::uint32_t(b));
    own_ = exec_.arena().template permanent_copy<std::uint32_t>(chosen);
    detail_ = exec_.arena().template permanent_copy<std::uint32_t>(around(tree.levels, depths_.detail, true));
    deposits_ = make_halo(bricks, around(tree.levels, depths_.deposits, false));
    beside_ = make_halo(bricks, around(tree.levels, depths_.beside, false));
    whole_ = make_halo(bricks, around(tree.levels, depths_.whole, false));
    const std::size_t most = std::max({2 * deposits_.cells(), beside_.cells(), whole_.cells()});
    row_ = exec_.arena().template permanent<std::uint64_t>(most);
  }

  BrickOctreeView own(BrickOctreeView view) const { return choose(view, own_); }
  BrickOctreeView detail(BrickOctreeView view) const { return choose(view, detail_); }

  std::uint64_t own_bricks() const { return own_count_; }
  std::uint64_t own_cells() const { return cells_; }
  std::size_t surface_first() const { return surface_first_; }  ///< its own surface cells are consecutive
  std::size_t surface_count() const { return surface_count_; }
  std::uint32_t own_first_brick() const { return std::uint32_t(own_first_); }
  std::size_t halo_bricks() const { return code_.size() - own_count_; }
  /// Cells around one of its own in which values are known, of which a brick's mean takes away one brick and a half.
  double known_around() const { return BrickOctreeView::width * (depths_.whole - 1.5) - 1; }
  /// Triangles in the lists of its own bricks.
  std::uint64_t own_lists(const BrickOctree& tree) const {
    const auto start = tree.list_start.download(own_first_, own_count_ + 1);
    return start.back() - start.front();
  }

  /// `work(view)` lets the particles of chosen bricks move, which leave deposits in two arrays. First those that may
  /// come to bricks of others: what they leave there goes to the owners while the rest moves. Cells of others are 0
  /// afterwards.
  template <class Work>
  void collect(const Array<std::uint64_t>& crossed, const Array<std::uint64_t>& ended, const BrickOctreeView& view,
               const Work& work) {
    const Array<std::uint64_t> arrays[] = {crossed, ended};
    work(choose(view, deposits_.border));
    {
      auto stage = exec_.stage("exchange");
      Side& out = deposits_.theirs;
      for (int k = 0; k < 2; ++k) {
        pack(out, arrays[k], 2, k);
        exec_.for_each(std::int64_t(out.bricks.size()),
                       detail::ClearBricks{brick_, out.listed.data(), arrays[k].data()});
      }
      begin<std::uint64_t>(out, deposits_.mine, 2);
    }
    work_inside(deposits_, view, work);
    auto stage = exec_.stage("exchange");
    const Side& in = deposits_.mine;
    const auto* row = finish<std::uint64_t>(in);
    for (int k = 0; k < 2; ++k)
      exec_.for_each(std::int64_t(in.bricks.size()),
                     detail::AddToBricks{brick_, in.listed.data(), in.start.data(), row, arrays[k].data(), 2, k});
  }

  /// Gives the cells beside its own bricks the values of their owners. `work(view)` reads those: bricks that lie among
  /// its own go first, while messages are on their way.
  template <class Value, class Work>
  void refresh_beside_for(const Array<Value>& value, const BrickOctreeView& view, const Work& work) {
    begin_refresh(beside_, value);
    work_inside(beside_, view, work);
    finish_refresh(beside_, value);
    work(choose(view, beside_.border));
  }

  /// The same after `work(view)` has made the values: of bricks that others wait for first, and of the rest while
  /// messages are on their way.
  template <class Value, class Work>
  void refresh_beside_of(const Array<Value>& value, const BrickOctreeView& view, const Work& work) {
    work(choose(view, beside_.border));
    begin_refresh(beside_, value);
    work_inside(beside_, view, work);
    finish_refresh(beside_, value);
  }

  /// Gives the whole halo the values of their owners; `meanwhile` touches none of them.
  template <class Value, class Work>
  void refresh(const Array<Value>& value, const Work& meanwhile) {
    begin_refresh(whole_, value);
    meanwhile();
    finish_refresh(whole_, value);
  }

  /// What the owner of each of these positions of the surface has there; all processes ask for the same. Collective.
  std::vector<float> of_owners(const std::vector<BandPoint>& positions, const std::vector<float>& own) const {
    std::vector<std::uint64_t> bits(positions.size());
    for (std::size_t k = 0; k < positions.size(); ++k) {
      const Int3 cell = positions[k].cell();
      constexpr int width = BrickOctreeView::width;
      if (owner_of(morton({cell.x / width, cell.y / width, cell.z / width})) == ranks_.rank())
        bits[k] = std::bit_cast<std::uint32_t>(own[k]);
    }
    ranks_.sum(bits);
    std::vector<float> values;
    for (const std::uint64_t each : bits) values.push_back(std::bit_cast<float>(std::uint32_t(each)));
    return values;
  }

 private:
  /// Bricks that take part in an exchange, those that concern one process after those that concern another.
  struct Side {
    std::vector<std::uint32_t> bricks;
    std::vector<std::uint64_t> starts;
    std::vector<std::pair<int, std::uint64_t>> ends;  ///< process, and where its cells end in the row
    Array<std::uint32_t> listed;
    Array<std::uint64_t> start;
    std::uint64_t cells = 0;
    std::vector<std::byte> row;
  };
  /// Bricks of this process that others have in their halos, and those of theirs that it has in its own.
  struct Halo {
    Side mine, theirs;
    Array<std::uint32_t> border, inside;  ///< own bricks that lie within the depth of one of others, and the rest
    std::size_t cells() const { return std::max<std::size_t>(1, std::max(mine.cells, theirs.cells)); }
  };

  static std::size_t at(int rank) { return static_cast<std::size_t>(rank); }

  BrickOctreeView choose(BrickOctreeView view, const Array<std::uint32_t>& bricks) const {
    static constexpr std::uint32_t nothing = 0;
    view.chosen = bricks.size() ? bricks.data() : &nothing;
    view.chosen_count = std::uint32_t(bricks.size());
    return view;
  }

  /// Bricks that are here, within `depth` of its own ones, with them or without.
  std::vector<std::uint32_t> around(int levels, int depth, bool with_own) const {
    std::vector<std::uint32_t> bricks;
    const std::span own(code_.data() + own_first_, own_count_);
    for (const std::uint64_t code : codes_around(own, depth, levels)) {
      const auto found = std::lower_bound(code_.begin(), code_.end(), code);
      if (found == code_.end() || *found != code) continue;
      const auto b = std::size_t(found - code_.begin());
      if (with_own || b < own_first_ || b >= own_first_ + own_count_) bricks.push_back(std::uint32_t(b));
    }
    return bricks;
  }

  int owner_of(std::uint64_t code) const {
    return int(std::upper_bound(begin_.begin(), begin_.end() - 1, code) - begin_.begin()) - 1;
  }

  /// Tells the owners of these bricks that they are wanted here. Throws Error where an owner has no such brick or
  /// another one: then the processes do not see the same surface.
  Halo make_halo(const std::vector<OctreeBrick>& bricks, std::vector<std::uint32_t> wanted) {
    Halo halo;
    std::vector<Ranks::Bytes> ask(at(ranks_.count()));
    for (const std::uint32_t b : wanted) {
      const std::uint64_t words[2] = {code_[b], hash_of(bricks[b])};
      Ranks::Bytes& to = ask[at(owner_of(code_[b]))];
      const auto* bytes = reinterpret_cast<const std::byte*>(words);
      to.insert(to.end(), bytes, bytes + sizeof words);
      add(halo.theirs, bricks, b, owner_of(code_[b]));
    }
    const std::vector<Ranks::Bytes> asked = ranks_.exchange(ask);
    std::uint64_t wrong = 0;
    for (int q = 0; q < ranks_.count(); ++q)
      for (std::size_t k = 0; k < asked[at(q)].size(); k += 16) {
        std::uint64_t words[2];
        std::memcpy(words, asked[at(q)].data() + k, sizeof words);
        const auto found = std::lower_bound(code_.begin(), code_.end(), words[0]);
        const auto b = std::size_t(found - code_.begin());
        if (found == code_.end() || *found != words[0] || hash_of(bricks[b]) != words[1])
          ++wrong;
        else
          add(halo.mine, bricks, std::uint32_t(b), q);
      }
    ranks_.sum({&wrong, 1});
    if (wrong > 0) throw Error("the processes do not see the same surface", "", "give all of them the same files");
    upload(halo.mine);
    upload(halo.theirs);
    divide(halo);
    return halo;
  }

  static std::uint64_t hash_of(const OctreeBrick& brick) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const CellMask* mask : {&brick.band, &brick.surface})
      for (const std::uint64_t word : mask->word) hash = (hash ^ word) * 0x100000001b3;
    return hash;
  }

  static void add(Side& side, const std::vector<OctreeBrick>& bricks, std::uint32_t b, int rank) {
    side.bricks.push_back(b);
    side.starts.push_back(side.cells);
    side.cells += detail::cells_of(bricks[b].surface);
    if (side.ends.empty() || side.ends.back().first != rank) side.ends.emplace_back(rank, 0);
    side.ends.back().second = side.cells;
  }

  /// What others want of its bricks is what lies within the depth of theirs.
  void divide(Halo& halo) {
    std::vector<bool> wanted(own_count_);
    for (const std::uint32_t b : halo.mine.bricks) wanted[b - own_first_] = true;
    std::vector<std::uint32_t> border, inside;
    for (std::size_t b = 0; b < own_count_; ++b) (wanted[b] ? border : inside).push_back(std::uint32_t(own_first_ + b));
    halo.border = exec_.arena().template permanent_copy<std::uint32_t>(border);
    halo.inside = exec_.arena().template permanent_copy<std::uint32_t>(inside);
  }

  void upload(Side& side) {
    side.listed = exec_.arena().template permanent_copy<std::uint32_t>(side.bricks);
    side.start = exec_.arena().template permanent_copy<std::uint64_t>(side.starts);
  }

  /// The parts of a row of `width` bytes a cell.
  static std::vector<Ranks::Part> parts(Side& side, std::size_t width) {
    std::vector<Ranks::Part> all;
    std::uint64_t first = 0;
    for (const auto& [rank, end] : side.ends) {
      if (end > first) all.push_back({rank, std::span(side.row).subspan(first * width, (end - first) * width)});
      first = end;
    }
    return all;
  }

  /// Copies values of a side into its row, ready to be sent; as one of several `arrays`, the last of which comes last.
  template <class Value>
  void pack(Side& side, const Array<Value>& value, int arrays = 1, int which = 0) {
    auto* row = reinterpret_cast<Value*>(row_.data());
    exec_.for_each(
        std::int64_t(side.bricks.size()),
        detail::PackBricks<Value>{brick_, side.listed.data(), side.start.data(), value.data(), row, arrays, which});
    if (which + 1 < arrays) return;
    side.row.resize(side.cells * sizeof(Value) * std::size_t(arrays));
    if (side.cells) exec_.device().copy_to_host(side.row.data(), row, side.row.size());
  }

  /// Begins to send the row of one side and to receive that of the other.
  template <class Value>
  void begin(Side& out, Side& in, int arrays = 1) {
    const std::size_t width = sizeof(Value) * std::size_t(arrays);
    in.row.resize(in.cells * width);
    const std::vector<Ranks::Part> to = parts(out, width), from = parts(in, width);
    ranks_.begin(to, from);
  }

  /// What has come, on the device.
  template <class Value>
  const Value* finish(const Side& in) {
    ranks_.finish();
    auto* row = reinterpret_cast<Value*>(row_.data());
    if (in.cells) exec_.device().copy_to_device(row, in.row.data(), in.row.size());
    return row;
  }

  /// Runs `work(view)` on the bricks inside, in some pieces, and lets messages move on in between.
  template <class Work>
  void work_inside(const Halo& halo, const BrickOctreeView& view, const Work& work) {
    constexpr std::size_t pieces = 8;
    const std::size_t n = halo.inside.size();
    for (std::size_t k = 0; k < pieces; ++k) {
      const std::size_t first = n * k / pieces, last = n * (k + 1) / pieces;
      if (first == last) continue;
      BrickOctreeView piece = view;
      piece.chosen = halo.inside.data() + first;
      piece.chosen_count = std::uint32_t(last - first);
      work(piece);
      ranks_.progress();
    }
  }

  template <class Value>
  void begin_refresh(Halo& halo, const Array<Value>& value) {
    auto stage = exec_.stage("exchange");
    pack(halo.mine, value);
    begin<Value>(halo.mine, halo.theirs);
  }

  template <class Value>
  void finish_refresh(Halo& halo, const Array<Value>& value) {
    auto stage = exec_.stage("exchange");
    const Side& in = halo.theirs;
    const Value* row = finish<Value>(in);
    exec_.for_each(std::int64_t(in.bricks.size()),
                   detail::UnpackBricks<Value>{brick_, in.listed.data(), in.start.data(), row, value.data()});
  }

  Executor<Backend>& exec_;
  Ranks& ranks_;
  std::vector<std::uint64_t> begin_;
  HaloDepths depths_;
  std::vector<std::uint64_t> code_;
  const OctreeBrick* brick_ = nullptr;
  std::size_t own_first_ = 0, own_count_ = 0, surface_first_ = 0, surface_count_ = 0;
  std::uint64_t cells_ = 0;
  Array<std::uint32_t> own_, detail_;
  Halo deposits_, beside_, whole_;
  Array<std::uint64_t> row_;
};

}  // namespace nacre
