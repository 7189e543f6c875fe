// Nacre: a dialog that picks a file, or a name to write to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace nacre {

class FileDialog {
 public:
  enum class Mode { open, save };

  /// Opens at the folder of last time. `extensions`: lower case, with dot; only such files are listed, all where there
  /// are none. `name`: to begin with, when saving.
  void open(Mode mode, std::string title, std::vector<std::string> extensions, const std::string& name = "");
  /// Draws it while it is open. Returns the files once they have been chosen; several of one folder may be opened.
  std::optional<std::vector<std::filesystem::path>> draw();

  bool is_open() const { return open_; }
  void close() { open_ = false; }

 private:
  struct Entry {
    std::string name;
    bool folder = false, chosen = false;
    std::uintmax_t bytes = 0;
  };

  void list();
  void enter(const std::filesystem::path& folder);
  void draw_places();
  void draw_entries();
  std::vector<std::filesystem::path> chosen() const;
  bool fits(const std::string& name) const;

  Mode mode_ = Mode::open;
  std::string title_, name_, trouble_;
  std::vector<std::string> extensions_;
  std::filesystem::path folder_;
  std::vector<Entry> entries_;
  bool open_ = false, begins_ = false, all_files_ = false, entered_ = false;
  bool takes_keys_ = false;          ///< after a click: what is typed goes to the name again
  std::filesystem::path overwrite_;  ///< asked about already
};

}  // namespace nacre
