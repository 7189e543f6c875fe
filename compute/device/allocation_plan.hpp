// Nacre: what arrays would take in an arena, by the code that makes them, before there is memory for them.
#pragma once

#include <cstddef>

#include "compute/device/arena.hpp"

namespace nacre {

/// Stands for an Arena where code allocates from a template parameter: its arrays have no memory and are only counted.
class AllocationPlan {
 public:
  template <class T>
  Array<T> permanent(std::size_t count) {
    bytes_ += Arena::aligned(count * sizeof(T));
    return {};
  }
  template <class T>
  Array<T> temporary(std::size_t count) {
    return permanent<T>(count);
  }

  std::size_t bytes() const { return bytes_; }

 private:
  std::size_t bytes_ = 0;
};

}  // namespace nacre
