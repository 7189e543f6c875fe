// Nacre: Thrust's transforming iterator, as far as Nacre uses it.
#pragma once

namespace thrust {

template <class Iterator, class Function>
struct transform_iterator {
  Iterator iterator;
  Function function;
  auto operator[](long k) const { return function(iterator[k]); }
};

template <class Iterator, class Function>
transform_iterator<Iterator, Function> make_transform_iterator(Iterator iterator, Function function) {
  return {iterator, function};
}

}  // namespace thrust
