// Nacre: frames of a flow that have been shown, so that they can be shown again without being computed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "app/viewer/flow/flow_worker.hpp"
#include "compute/math/vec.hpp"
#include "engine/gl/buffer.hpp"
#include "engine/gl/texture.hpp"

namespace nacre {

/// A frame: what is on the surface at a time of the data.
struct KeptFrame {
  Buffer values;  ///< shown values, one per surface cell, on the graphics device
  BufferTexture texture;
  FlowMoment moment;
  std::size_t bytes = 0;
  std::uint64_t age = 0;  ///< larger than that of all before
};

/// At most one for each position; the oldest go where memory would not suffice.
class KeptFrames {
 public:
  explicit KeptFrames(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Copies `shown` on the graphics device.
  void keep(int position, const Buffer& shown, const FlowMoment& moment);
  /// Null: there is none.
  const KeptFrame* find(int position) const {
    const auto found = frames_.find(position);
    return found == frames_.end() ? nullptr : &found->second;
  }
  /// The position of a frame that there is, as near as possible; there must be one.
  int nearest(int position) const;
  void clear() { frames_.clear(), bytes_ = 0; }
  std::size_t bytes() const { return bytes_; }

 private:
  void drop(int position);
  void drop_oldest();

  std::size_t most_bytes_, bytes_ = 0;
  std::uint64_t age_ = 0;
  std::map<int, KeptFrame> frames_;
};

}  // namespace nacre
