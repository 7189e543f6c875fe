// Nacre: Thrust's transforming iterator by rocPRIM.
#pragma once

#include <rocprim/iterator/transform_iterator.hpp>

namespace thrust {
template <class In, class Get>
auto make_transform_iterator(In in, const Get& get) {
  return rocprim::make_transform_iterator(in, get);
}
}  // namespace thrust
