// Nacre: the knob table: one declaration per knob feeds command line, session file, report and panels.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// A knob's name for what may be written with dashes.
std::string snake_case(std::string name);

/// Where a knob's value is stored as one of an enumeration's values; value k has the name `choices[k]`.
struct KnobChoice {
  void* place;
  int (*get)(const void* place);
  void (*set)(void* place, int value);
};

template <class Enum>
KnobChoice knob_choice(Enum& place) {
  return {&place, [](const void* p) { return int(*static_cast<const Enum*>(p)); },
          [](void* p, int value) { *static_cast<Enum*>(p) = Enum(value); }};
}

/// One knob, bound to its place in a Settings.
struct Knob {
  std::string name;   ///< snake_case; on the command line --with-dashes
  std::string group;  ///< the panel it is in
  std::string unit;
  std::string help;  ///< one line
  std::variant<int*, double*, std::uint32_t*, bool*, std::string*, KnobChoice> value;
  double min = 0, max = 0;           ///< of a number
  std::vector<std::string> choices;  ///< of an enumeration, or of a string (empty: any)
  std::uint32_t* also = nullptr;     ///< a second place with the same value

  std::string option() const;                       ///< "--step-cells"
  std::string text() const;                         ///< the value as on the command line
  bool concerns(const std::string& command) const;  ///< the general ones concern all
};

/// The table, bound to `settings`, which must outlive it.
std::vector<Knob> knobs(Settings& settings);

/// Sets a knob from text. Throws Error where there is no such knob (with the nearest name), the text is no value of its
/// type, or it is out of range.
void set_knob(Settings& settings, const std::string& name, const std::string& text);

/// All values, by name.
nlohmann::json knob_values(const Settings& settings);

/// Sets the knobs that `values` has. Throws Error as `set_knob` does.
void set_knobs(Settings& settings, const nlohmann::json& values);

/// The table for `nacre --knobs`: name, default, range, unit, help.
std::string knob_table();

}  // namespace nacre
