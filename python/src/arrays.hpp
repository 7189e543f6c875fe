// Nacre: arrays of numpy as those of the library, and back.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <nacre/error.hpp>
#include <nacre/knobs.hpp>
#include <string>
#include <vector>

namespace nacre::python {

namespace nb = nanobind;

/// Rows of three or four numbers; python/nacre has made it contiguous and of this type.
template <class T, std::size_t N>
using Rows = nb::ndarray<const T, nb::shape<-1, nb::ssize_t(N)>, nb::c_contig, nb::device::cpu>;
template <class T>
using Column = nb::ndarray<const T, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

template <std::size_t N, class Array>
auto to_rows(const Array& from) {
  std::vector<std::array<std::remove_const_t<typename Array::Scalar>, N>> rows(from.shape(0));
  if (!rows.empty()) std::memcpy(rows.data(), from.data(), rows.size() * sizeof(rows[0]));
  return rows;
}

/// Numbers of points; one that is negative or beyond 32 bits becomes the largest there is, which no surface has.
template <std::size_t N, class Array>
auto to_corners(const Array& from) {
  std::vector<std::array<std::uint32_t, N>> rows(from.shape(0));
  const std::int64_t* at = from.data();
  for (auto& row : rows)
    for (std::uint32_t& corner : row) {
      const std::int64_t value = *at++;
      corner = value < 0 || value > 0xffffffffLL ? 0xffffffffu : std::uint32_t(value);
    }
  return rows;
}

/// An array of numpy that owns `values`.
template <class T>
nb::object column(std::vector<T> values) {
  auto* kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, T>(kept->data(), {kept->size()}, owner));
}

template <class T, std::size_t N>
nb::object rows(std::vector<std::array<T, N>> values) {
  auto* kept = new std::vector<std::array<T, N>>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<std::array<T, N>>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, T>(reinterpret_cast<T*>(kept->data()), {kept->size(), N}, owner));
}

template <std::size_t N>
nb::object corner_rows(const std::vector<std::array<std::uint32_t, N>>& values) {
  std::vector<std::array<std::int64_t, N>> wide(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t k = 0; k < N; ++k) wide[i][k] = values[i][k];
  return rows(std::move(wide));
}

KnobValue knob_value(nb::handle value);
KnobValues knob_values(const nb::dict& values);
nb::object to_python(const KnobValue& value);

void bind_meshing(nb::module_& module);
void bind_flow(nb::module_& module);

}  // namespace nacre::python
