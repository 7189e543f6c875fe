// Nacre: presets: many knobs at once, under a name; those of the program, and those that the user has saved.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/scene/settings/settings.hpp"

namespace nacre {

struct KnobPreset {
  std::string name, job;  ///< "flow", "mesh"
  std::string help;
  std::map<std::string, std::string> knobs;  ///< by name, as on the command line
};

/// Those of the program.
const std::vector<KnobPreset>& built_in_presets();

/// The choice in the tab of the knobs.
class KnobPresets {
 public:
  /// Keeps those of the user in the folder for configuration of the system's user ($XDG_CONFIG_HOME/nacre/presets).
  KnobPresets();
  explicit KnobPresets(std::filesystem::path folder);

  /// With Dear ImGui.
  void draw(Settings& settings, const std::string& job);

  /// Of the program and of the user, for a job.
  std::vector<KnobPreset> of(const std::string& job) const;
  /// Saves the knobs of `job` that are not as the viewer begins with them, without those that name data. Throws Error.
  void save(const std::string& name, const std::string& job, Settings& settings);

 private:
  void read();

  std::filesystem::path folder_;
  std::vector<KnobPreset> own_;
  std::string name_, trouble_;
  bool read_ = false;
};

/// What a preset does not say stays. Throws Error where a knob is not known, or out of range.
void apply_preset(const KnobPreset& preset, Settings& settings);

}  // namespace nacre
