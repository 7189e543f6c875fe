// Nacre: which knobs have changed since the last frame. It is computed once a frame and passed to all that need it.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <map>
#include <string>

#include "engine/scene/session/session.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {

class ChangedKnobs {
 public:
  ChangedKnobs() = default;
  /// `values`: new values by the names of knobs, as in SessionEvent.
  explicit ChangedKnobs(std::map<std::string, std::string> values) : values_(std::move(values)) {}

  bool empty() const { return values_.empty(); }
  bool has(const char* name) const { return values_.contains(name); }
  bool has_any(std::initializer_list<const char*> names) const {
    return std::any_of(names.begin(), names.end(), [this](const char* name) { return has(name); });
  }

 private:
  std::map<std::string, std::string> values_;
};

/// Those that differ.
inline ChangedKnobs changed_knobs(const Session& before, const Session& after) {
  std::optional<SessionEvent> change = session_change(before, after);
  return change ? ChangedKnobs(std::move(change->knobs)) : ChangedKnobs();
}

/// Does a result, a mesh or a texture, depend on one of these knobs? Those of what is drawn, and when, do not count.
inline bool changes_result(const std::map<std::string, std::string>& changed) {
  constexpr const char* groups[] = {"embedding", "flow", "materials", "fields", "sizing", "particles", "cells"};
  Settings settings;
  const std::vector<Knob> all = knobs(settings);
  return std::any_of(all.begin(), all.end(), [&](const Knob& knob) {
    return changed.contains(knob.name) && knob.name != "begin_at" &&
           std::find(std::begin(groups), std::end(groups), knob.group) != std::end(groups);
  });
}

}  // namespace nacre
