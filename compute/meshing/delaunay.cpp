// Nacre: the Delaunay triangulation of the particles, by CGAL, brought into an order that threads do not change.
#include "compute/meshing/delaunay.hpp"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/device/worker_arena.hpp"
#include "compute/math/point_hash.hpp"
#include "compute/meshing/delaunay_order.hpp"

namespace nacre {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<std::int32_t, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
// Without a lock grid the parallel one works sequentially: one instantiation serves both.
using Structure = CGAL::Triangulation_data_structure_3<VertexBase, CellBase, CGAL::Parallel_tag>;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;
using LockGrid = Triangulation::Lock_data_structure;
using Vertex = Triangulation::Vertex_handle;

#ifdef __SANITIZE_THREAD__
constexpr bool may_thread = false;  // false alarms within oneTBB
#else
constexpr bool may_thread = true;
#endif

constexpr std::size_t few_points = 4096;  // locks cost more than they gain
constexpr int lock_cells = 50;            // per axis
constexpr std::size_t dear_removal = 50;  // taking a point out costs less than this many insertions on all threads

CGAL::Bbox_3 box_of(std::span<const Vec3d> points) {
  Vec3d lower = points[0], upper = points[0];
  for (const Vec3d& p : points) lower = min(lower, p), upper = max(upper, p);
  return {lower.x, lower.y, lower.z, upper.x, upper.y, upper.z};
}

/// Order of insertion: random rounds of growing size, each along a Hilbert curve.
std::vector<std::size_t> insertion_order(const std::vector<Kernel::Point_3>& points, bool threaded) {
  using Map = CGAL::Pointer_property_map<Kernel::Point_3>::const_type;
  using Traits = CGAL::Spatial_sort_traits_adapter_3<Kernel, Map>;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  if (order.empty()) return order;
  const Traits traits(CGAL::make_property_map(points));
  if (threaded)
    CGAL::spatial_sort<CGAL::Parallel_tag>(order.begin(), order.end(), traits);
  else
    CGAL::spatial_sort<CGAL::Sequential_tag>(order.begin(), order.end(), traits);
  return order;
}

/// Puts the points of these numbers into a triangulation, one after the other or, where it has locks, on many threads.
/// `vertices` gets the vertex of each.
class Insertion {
 public:
  Insertion(Triangulation& triangulation, std::span<const Vec3d> points, std::span<const std::uint32_t> numbers,
            std::vector<Vertex>& vertices, const std::atomic<bool>* stop)
      : triangulation_(triangulation), numbers_(numbers), vertices_(vertices), stop_(stop) {
    points_.reserve(numbers.size());
    for (const std::uint32_t i : numbers) points_.emplace_back(points[i].x, points[i].y, points[i].z);
    order_ = insertion_order(points_, triangulation.is_parallel());
  }

  void run() {
    Vertex hint;
    std::size_t begin = 0;
    const std::size_t alone = triangulation_.is_parallel() ? 100 : order_.size();
    for (; begin < order_.size() && (begin < alone || triangulation_.dimension() < 3) && !stopped(); ++begin)
      insert(order_[begin], hint, nullptr);
    if (begin < order_.size() && !stopped()) {
      tbb::enumerable_thread_specific<Vertex> hints(hint);
      tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, order_.size()), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end() && !stopped(); ++i)
          insert_locked(order_[i], hints.local());
      });
    }
    check_stop(stop_);
  }

 private:
  bool stopped() const { return is_set(stop_); }

  bool insert(std::size_t point, Vertex& hint, bool* could_lock) {
    const Vertex vertex = triangulation_.insert(points_[point], hint, could_lock);
    if (could_lock && !*could_lock) return false;
    vertices_[numbers_[point]] = hint = vertex;
    return true;
  }

  void insert_locked(std::size_t point, Vertex& hint) {
    for (bool done = false; !done;) {
      bool could_lock = false;
      if (triangulation_.try_lock_vertex(hint) && triangulation_.try_lock_point(points_[point]))
        done = insert(point, hint, &could_lock);
      triangulation_.unlock_all_elements();
      if (!done) std::this_thread::yield();  // who holds the lock may be waiting for this processor
    }
  }

  Triangulation& triangulation_;
  std::span<const std::uint32_t> numbers_;
  std::vector<Vertex>& vertices_;
  const std::atomic<bool>* stop_;
  std::vector<Kernel::Point_3> points_;
  std::vector<std::size_t> order_;
};

/// Points by where they are.
class PlaceTable {
 public:
  explicit PlaceTable(std::span<const Vec3d> points)
      : points_(points), slots_(std::bit_ceil(2 * points.size() + 2), none) {
    for (std::uint32_t i = 0; i < points.size(); ++i)
      if (std::uint32_t& slot = slots_[slot_of(points[i])]; slot == none) slot = i;
  }

  /// The first point there, or `none`.
  std::uint32_t find(const Vec3d& position) const { return slots_[slot_of(position)]; }

 private:
  /// The slot of the position, or the empty one where it would go.
  std::size_t slot_of(const Vec3d& position) const {
    const std::uint64_t key = hash_point(0, position);
    std::size_t slot = (key ^ key >> 32) & (slots_.size() - 1);
    while (slots_[slot] != none && !(points_[slots_[slot]] == position)) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  std::span<const Vec3d> points_;
  std::vector<std::uint32_t> slots_;
};

/// Copies the finite cells as the triangulation happens to hold them.
DelaunayCells copy_cells(const Triangulation& triangulation) {
  std::vector<Triangulation::Cell_handle> handles;
  handles.reserve(triangulation.number_of_cells());
  for (auto cell = triangulation.all_cells_begin(); cell != triangulation.all_cells_end(); ++cell) {
    const bool finite = !triangulation.is_infinite(cell);
    cell->info() = finite ? std::int32_t(handles.size()) : -1;
    if (finite) handles.push_back(cell);
  }
  DelaunayCells cells;
  cells.vertices.resize(handles.size());
  cells.neighbours.resize(handles.size());
  tbb::parallel_for(std::size_t(0), handles.size(), [&](std::size_t i) {
    for (int k = 0; k < 4; ++k) {
      cells.vertices[i][k] = handles[i]->vertex(k)->info();
      cells.neighbours[i][k] = handles[i]->neighbor(k)->info();
    }
    order_corners(cells.vertices[i], cells.neighbours[i]);
  });
  return cells;
}

}  // namespace

/// What is kept from one call to the next.
struct Delaunay::Held {
  Triangulation triangulation;
  std::vector<Vec3d> points;
  std::vector<Vertex> vertices;  ///< per point

  /// Takes out the points that are not in `now`; the numbers of those that are to be put in, ascending. All, where
  /// building all of it costs less: then all of this is as new.
  std::vector<std::uint32_t> keep(std::span<const Vec3d> now, const std::atomic<bool>* stop) {
    const PlaceTable known(points);
    std::vector<Vertex> at(now.size());
    std::vector<std::uint32_t> fresh;
    std::vector<char> stays(points.size(), 0);
    for (std::size_t i = 0; i < now.size(); ++i)
      if (const std::uint32_t old = known.find(now[i]); old != none)
        at[i] = vertices[old], stays[old] = 1;
      else
        fresh.push_back(std::uint32_t(i));
    std::vector<Vertex> gone;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!stays[i] && known.find(points[i]) == i) gone.push_back(vertices[i]);  // others share the vertex of the first
    vertices = std::move(at);
    if (gone.size() <= now.size() / dear_removal) {
      for (const Vertex vertex : gone) {
        check_stop(stop);
        triangulation.remove(vertex);
      }
      return fresh;
    }
    triangulation.clear();
    fresh.resize(now.size());
    std::iota(fresh.begin(), fresh.end(), 0u);
    return fresh;
  }

  void triangulate(std::span<const Vec3d> now, bool threaded, const std::atomic<bool>* stop) {
    const std::vector<std::uint32_t> fresh = keep(now, stop);
    std::unique_ptr<LockGrid> locks;
    if (threaded && fresh.size() > few_points) locks = std::make_unique<LockGrid>(box_of(now), lock_cells);
    points.assign(now.begin(), now.end());
    triangulation.set_lock_data_structure(locks.get());
    Insertion(triangulation, now, fresh, vertices, stop).run();
    triangulation.set_lock_data_structure(nullptr);
    for (std::size_t i = now.size(); i-- > 0;)
      vertices[i]->info() = std::uint32_t(i);  // the first of those that coincide
    if (triangulation.dimension() < 3) refuse_flat_points();
  }
};

Delaunay::Delaunay(int threads) : threads_(threads) {}
Delaunay::~Delaunay() = default;

DelaunayCells Delaunay::cells(std::span<const Vec3d> points, const std::atomic<bool>* stop) {
  check_delaunay_points(points);
  WorkerArena workers(threads_ > 0 ? threads_ : tbb::this_task_arena::max_concurrency());
  tbb::task_arena& arena = workers.get();
  return arena.execute([&] {
    std::unique_ptr<Held> held = held_ ? std::move(held_) : std::make_unique<Held>();  // lost where this throws
    held->triangulate(points, may_thread && arena.max_concurrency() > 1, stop);
    const DelaunayCells raw = copy_cells(held->triangulation);
    held_ = std::move(held);
    return in_canonical_order(raw, points, stop);
  });
}

}  // namespace nacre
