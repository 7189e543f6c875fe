// Nacre: parameters of a run by name. The same names, defaults and ranges as everywhere in Nacre.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "export.hpp"

namespace nacre {

/// Value of a knob. A whole number is taken where a real one is expected.
using KnobValue = std::variant<bool, std::int64_t, double, std::string>;

/// Knobs by name, for example {{"max_size", 1.5}, {"seed", 7}}. Those that are left out have their defaults.
using KnobValues = std::map<std::string, KnobValue>;

enum class Job { mesh, flow };

/// What a knob is.
struct KnobDescription {
  std::string name;
  std::string help;   ///< one line
  std::string unit;   ///< "voxels", "cells", "degrees", ...; empty: none
  std::string group;  ///< those of one group belong together
  KnobValue value;    ///< its default
  double min = 0, max = 0;
  std::vector<std::string> choices;  ///< the values of a text that may be chosen from; empty: any text
  bool live = false;                 ///< may be changed while the run goes on
};

/// All knobs of a job, in a fixed order. Lengths in voxels are multiples of the smallest spacing of the volume.
NACRE_API std::vector<KnobDescription> describe_knobs(Job job);

}  // namespace nacre
