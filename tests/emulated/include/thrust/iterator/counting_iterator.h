// Nacre: Thrust's counting iterator, as far as Nacre uses it.
#pragma once

namespace thrust {

template <class T>
struct counting_iterator {
  T first;
  T operator[](long k) const { return first + T(k); }
};

template <class T>
counting_iterator<T> make_counting_iterator(T first) {
  return {first};
}

}  // namespace thrust
