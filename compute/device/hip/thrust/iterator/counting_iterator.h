// Nacre: Thrust's counting iterator by rocPRIM.
#pragma once

#include <rocprim/iterator/counting_iterator.hpp>

namespace thrust {
template <class Count>
rocprim::counting_iterator<Count> make_counting_iterator(Count first) {
  return rocprim::counting_iterator<Count>(first);
}
}  // namespace thrust
