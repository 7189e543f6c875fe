// Nacre: earlier iterations of the particles.
#include "app/viewer/mesh/kept_particles.hpp"

#include <iterator>
#include <utility>

namespace nacre {

void KeptParticles::keep(int iteration, const Buffer& position, const Buffer& direction, const ShownCounts& counts) {
  const std::size_t bytes = std::size_t(counts.total()) * sizeof(Float4);
  if (bytes == 0 || 2 * bytes > most_bytes_ || kept_.contains(iteration)) return;
  while (iteration % stride_ == 0 && bytes_ + 2 * bytes > most_bytes_ && !kept_.empty()) thin_out();
  if (iteration % stride_ != 0) return;
  KeptIteration kept{Buffer(bytes), Buffer(bytes), counts};
  glCopyNamedBufferSubData(position.id(), kept.position.id(), 0, 0, GLsizeiptr(bytes));
  glCopyNamedBufferSubData(direction.id(), kept.direction.id(), 0, 0, GLsizeiptr(bytes));
  bytes_ += 2 * bytes;
  kept_.emplace(iteration, std::move(kept));
}

const KeptIteration* KeptParticles::find(int iteration) const {
  if (kept_.empty()) return nullptr;
  const auto after = kept_.upper_bound(iteration);
  return after == kept_.begin() ? &after->second : &std::prev(after)->second;
}

void KeptParticles::thin_out() {
  stride_ *= 2;
  for (auto at = kept_.begin(); at != kept_.end();) {
    if (at->first % stride_ == 0) {
      ++at;
      continue;
    }
    bytes_ -= at->second.position.bytes() + at->second.direction.bytes();
    at = kept_.erase(at);
  }
}

}  // namespace nacre
