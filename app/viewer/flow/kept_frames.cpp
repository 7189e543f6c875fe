// Nacre: frames of a flow that have been shown.
#include "app/viewer/flow/kept_frames.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace nacre {

void KeptFrames::keep(int position, const Buffer& shown, const FlowMoment& moment) {
  drop(position);
  KeptFrame frame;
  frame.bytes = shown.bytes() + moment.bytes();
  if (frame.bytes > most_bytes_) return;
  while (bytes_ + frame.bytes > most_bytes_) drop_oldest();
  frame.values = Buffer(shown.bytes());
  glCopyNamedBufferSubData(shown.id(), frame.values.id(), 0, 0, GLsizeiptr(shown.bytes()));
  frame.texture = BufferTexture(frame.values, GL_R32F);
  frame.moment = moment;
  frame.age = ++age_;
  bytes_ += frame.bytes;
  frames_.emplace(position, std::move(frame));
}

int KeptFrames::nearest(int position) const {
  return std::min_element(
             frames_.begin(), frames_.end(),
             [&](const auto& a, const auto& b) { return std::abs(a.first - position) < std::abs(b.first - position); })
      ->first;
}

void KeptFrames::drop(int position) {
  const auto found = frames_.find(position);
  if (found == frames_.end()) return;
  bytes_ -= found->second.bytes;
  frames_.erase(found);
}

void KeptFrames::drop_oldest() {
  drop(std::min_element(frames_.begin(), frames_.end(), [](const auto& a, const auto& b) {
         return a.second.age < b.second.age;
       })->first);
}

}  // namespace nacre
