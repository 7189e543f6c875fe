// Nacre: what all cells of a lattice know, those of tiles that are not stored among them.
#pragma once

#include <vector>

#include "compute/field/sizing.hpp"

namespace nacre::test {

template <class View, class Value>
struct ReadCell {
  View view;
  Lattice lattice;
  Value* value;
  NACRE_HD void operator()(std::int64_t i) const { value[i] = view.at(lattice.cell(i)); }
};

template <class Value, class Backend, class Field>
std::vector<Value> values_of_cells(Executor<Backend>& exec, const Field& field) {
  Arena::Scope scope(exec.arena());
  const Lattice& lattice = field.lattice();
  Array<Value> out = exec.arena().template temporary<Value>(lattice.count());
  exec.for_each(lattice.count(), ReadCell<decltype(field.view()), Value>{field.view(), lattice, out.data()});
  return out.download();
}

/// Per cell, x fastest: its closest interface point.
template <class Backend>
std::vector<std::uint32_t> nearest_of_cells(Executor<Backend>& exec, const DistanceField& field) {
  return values_of_cells<std::uint32_t>(exec, field);
}

/// Per cell, x fastest: its size.
template <class Backend>
std::vector<float> sizes_of_cells(Executor<Backend>& exec, const SizingField& field) {
  return values_of_cells<float>(exec, field);
}

}  // namespace nacre::test
