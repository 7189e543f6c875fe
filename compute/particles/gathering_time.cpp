// Nacre: how long the red-black solver takes to gather neighbourhoods.
#include "compute/particles/gathering_time.hpp"

#include <algorithm>
#include <chrono>

#include "compute/device/executor_cpu.hpp"
#include "compute/particles/neighbourhoods.hpp"
#include "compute/particles/solver_state.hpp"

namespace nacre {
namespace {

/// A turn that copies every neighbourhood and then does nothing with it.
struct LeaveAlone {
  std::size_t scratch_bytes() const { return 0; }
  void operator()(Team&, const Neighbourhood&) const {}
};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

GatheringTime time_gathering(Device& device, const ParticleSpans& particles, const std::atomic<bool>* stop) {
  Executor<Cpu> exec(device);
  exec.watch(stop);
  ParticleSet set;
  set.count = std::int64_t(particles.position.size());
  set.position = exec.arena().permanent_copy<Float4>(particles.position);
  set.direction = exec.arena().permanent_copy<Float4>(particles.direction);
  set.interface = exec.arena().permanent_copy<std::uint32_t>(particles.interface);
  GatheringTime best{1e300, 1e300};
  for (int turn = 0; turn < 5; ++turn) {
    Arena::Scope scope(exec.arena());
    const double before = now();
    Neighbourhoods<Cpu> neighbourhoods(exec, set, SolverParameters().step);
    const double binned = now();
    neighbourhoods.for_each(LeaveAlone{});
    best.binning = std::min(best.binning, binned - before);
    best.copying = std::min(best.copying, now() - binned);
  }
  return best;
}

}  // namespace nacre
