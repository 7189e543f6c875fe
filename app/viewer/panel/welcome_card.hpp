// Nacre: what a newcomer sees first: how to open something of one's own, or something that is there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/scene/free_area.hpp"

namespace nacre {

/// A file that was opened before, and the OpenGL texture with a small picture of it; 0: there is none.
struct RecentFile {
  std::filesystem::path file;
  unsigned picture = 0;
};

class WelcomeCard {
 public:
  /// What was clicked on.
  struct Wish {
    bool open = false;                          ///< the dialog
    std::string sample;                         ///< empty: none
    std::string tour;                           ///< text of a session; empty: none
    std::optional<std::filesystem::path> file;  ///< of those opened last
  };

  void show() { shown_ = true; }
  void hide() { shown_ = false; }
  bool is_shown() const { return shown_; }

  /// With Dear ImGui, over the middle of `area`, while it is shown. Every choice hides it.
  Wish draw(const FreeArea& area, const std::vector<RecentFile>& recent);

 private:
  bool shown_ = false;
};

}  // namespace nacre
