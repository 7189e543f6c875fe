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
  void* member;
  int (*get)(const void* member);
  void (*set)(void* member, int value);
};

template <class Enum>
KnobChoice knob_choice(Enum& member) {
  return {&member, [](const void* p) { return int(*static_cast<const Enum*>(p)); },
          [](void* p, int value) { *static_cast<Enum*>(p) = Enum(value); }};
}

/// One knob, bound to its member of a Settings.
struct Knob {
  std::string name;       ///< snake_case; on the command line --with-dashes
  std::string group;      ///< the part of the panel that it is in
  std::string unit = {};  ///< empty: none
  std::string help;       ///< one line
  std::variant<int*, double*, std::uint32_t*, bool*, std::string*, KnobChoice> value;
  double min = 0, max = 0;                  ///< of a number
  bool or_zero = false;                     ///< 0 is allowed besides: the program chooses
  std::vector<std::string> choices = {};    ///< of an enumeration, or of a string (empty: any)
  std::uint32_t* also = nullptr;            ///< a second member with the same value
  std::vector<std::string> old_names = {};  ///< former names: still read from sessions and command lines
  std::string off_option = {};              ///< an option of its own that turns it off; empty: --no- and its name

  std::string option() const;                       ///< "--step-cells"
  std::vector<std::string> off_options() const;     ///< "--no-edges", for what is on or off; empty for others
  std::vector<std::string> old_options() const;     ///< the options that belong to its former names
  std::string text() const;                         ///< the value as on the command line
  bool concerns(const std::string& command) const;  ///< the general ones concern all
  bool is_named(const std::string& wanted) const;   ///< by its name or a former one, in snake_case
};

/// The table, bound to `settings`, which must outlive it.
std::vector<Knob> knobs(Settings& settings);

/// Sets a knob from text; `name` may be a former one. Throws Error where there is no such knob (with the nearest name),
/// the text is not a value of its type, or it is out of range.
void set_knob(Settings& settings, const std::string& name, const std::string& text);

/// All values, by name.
nlohmann::json knob_values(const Settings& settings);

/// Sets the knobs that `values` has. Throws Error as `set_knob` does.
void set_knobs(Settings& settings, const nlohmann::json& values);

/// The table for `nacre --knobs`: name, default, range, unit, help.
std::string knob_table();

}  // namespace nacre
