// Nacre: a dialog that picks a file.
#include "app/viewer/panel/file_dialog.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <utility>

namespace nacre {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string size_text(std::uintmax_t bytes) {
  if (bytes < 1000) return fmt::format("{} B", bytes);
  if (bytes < 1000 * 1000) return fmt::format("{:.0f} kB", double(bytes) / 1e3);
  if (bytes < 1000 * 1000 * 1000) return fmt::format("{:.1f} MB", double(bytes) / 1e6);
  return fmt::format("{:.1f} GB", double(bytes) / 1e9);
}

fs::path home() {
  const char* folder = std::getenv("HOME");
  return folder ? fs::path(folder) : fs::path("/");
}

}  // namespace

void FileDialog::open(Mode mode, std::string title, std::vector<std::string> extensions, const std::string& name) {
  mode_ = mode;
  title_ = std::move(title);
  extensions_ = std::move(extensions);
  name_ = name;
  overwrite_.clear();
  all_files_ = false;
  open_ = begins_ = true;
  std::error_code error;
  if (folder_.empty()) folder_ = fs::current_path(error);
  if (folder_.empty() || !fs::is_directory(folder_, error)) folder_ = home();
  list();
}

bool FileDialog::fits(const std::string& name) const {
  if (all_files_ || extensions_.empty()) return true;
  const std::string small = lower(name);
  return std::any_of(extensions_.begin(), extensions_.end(), [&](const std::string& e) { return small.ends_with(e); });
}

void FileDialog::list() {
  entries_.clear();
  trouble_.clear();
  std::error_code error;
  fs::directory_iterator each(folder_, fs::directory_options::skip_permission_denied, error);
  if (error) trouble_ = error.message();
  for (; !error && each != fs::directory_iterator(); each.increment(error)) {
    Entry entry;
    entry.name = each->path().filename().string();
    if (entry.name.starts_with('.')) continue;
    std::error_code ignored;
    entry.folder = each->is_directory(ignored);
    if (!entry.folder && !fits(entry.name)) continue;
    if (!entry.folder) entry.bytes = each->file_size(ignored);
    entries_.push_back(std::move(entry));
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.folder != b.folder ? a.folder : lower(a.name) < lower(b.name);
  });
}

void FileDialog::enter(const fs::path& folder) {
  folder_ = folder.lexically_normal();
  if (mode_ == Mode::open) name_.clear();
  takes_keys_ = true;
  list();
}

/// The folder's own path as buttons, one a level.
void FileDialog::draw_places() {
  fs::path to;
  std::optional<fs::path> wanted;
  if (ImGui::SmallButton("home")) wanted = home();
  int level = 0;
  for (const fs::path& part : folder_) {
    to /= part;
    if (part.empty()) continue;
    ImGui::SameLine(0, 2);
    if (ImGui::SmallButton(fmt::format("{}##{}", part.string(), level++).c_str())) wanted = to;
  }
  if (wanted) enter(*wanted);
}

void FileDialog::draw_entries() {
  const float below = 3.4f * ImGui::GetFrameHeightWithSpacing();
  if (!ImGui::BeginTable("files", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY, ImVec2(0, -below))) return;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("size", ImGuiTableColumnFlags_WidthFixed, 6 * ImGui::GetFontSize());
  std::optional<fs::path> into;
  for (Entry& entry : entries_) {
    ImGui::TableNextColumn();
    const std::string label = entry.folder ? entry.name + "/" : entry.name;
    const auto flags = ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick |
                       ImGuiSelectableFlags_DontClosePopups;
    if (ImGui::Selectable(label.c_str(), entry.chosen, flags)) {
      const bool more = mode_ == Mode::open && ImGui::GetIO().KeyCtrl, taken_back = more && entry.chosen;
      for (Entry& other : entries_) other.chosen = other.chosen && more;
      entry.chosen = !entry.folder && !taken_back;
      if (entry.folder && ImGui::IsMouseDoubleClicked(0)) into = folder_ / entry.name;
      if (!entry.folder) name_ = taken_back ? "" : entry.name;
      if (entry.folder && mode_ == Mode::open) name_ = entry.name + "/";  // which Enter opens
      takes_keys_ = true;
      for (const Entry& other : entries_)
        if (taken_back && other.chosen) name_ = other.name;
      if (!entry.folder && ImGui::IsMouseDoubleClicked(0)) entered_ = true;
    }
    ImGui::TableNextColumn();
    if (!entry.folder) ImGui::TextUnformatted(size_text(entry.bytes).c_str());
  }
  ImGui::EndTable();
  if (into) enter(*into);
}

std::vector<fs::path> FileDialog::chosen() const {
  std::vector<fs::path> files;
  if (mode_ == Mode::open)
    for (const Entry& entry : entries_)
      if (entry.chosen) files.push_back(folder_ / entry.name);
  if (files.size() > 1) return files;
  if (name_.empty()) return {};
  return {fs::path(name_).is_absolute() ? fs::path(name_) : folder_ / name_};
}

std::optional<std::vector<fs::path>> FileDialog::draw() {
  if (!open_) return {};
  if (std::exchange(begins_, false)) ImGui::OpenPopup(title_.c_str());
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowSize(ImVec2(std::min(all.x * 0.9f, 44 * ImGui::GetFontSize()), all.y * 0.7f),
                           ImGuiCond_Appearing);
  ImGui::SetNextWindowPos(ImVec2(all.x / 2, all.y / 2), ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
  if (!ImGui::BeginPopupModal(title_.c_str(), &open_)) return {};
  entered_ = false;
  draw_places();
  draw_entries();
  if (!trouble_.empty()) ImGui::TextUnformatted(trouble_.c_str());
  ImGui::SetNextItemWidth(-1);
  if (std::exchange(takes_keys_, false) || ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  if (ImGui::InputTextWithHint("##name", mode_ == Mode::save ? "name" : "name or path", &name_,
                               ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll))
    entered_ = true;
  if (ImGui::IsItemEdited())  // what is typed is meant, not what was clicked on before
    for (Entry& entry : entries_) entry.chosen = false;
  std::optional<std::vector<fs::path>> result;
  const std::vector<fs::path> files = chosen();
  std::error_code ignored;
  if (entered_ && files.size() == 1 && fs::is_directory(files[0], ignored)) {
    enter(files[0]);
    entered_ = false;
  }
  const bool exists = mode_ == Mode::save && files.size() == 1 && fs::exists(files[0], ignored);
  const bool asks = exists && overwrite_ == files[0];
  const std::string several = fmt::format("open {} files###open", files.size());
  const char* label = asks                  ? "replace it"
                      : mode_ == Mode::save ? "save"
                      : files.size() > 1    ? several.c_str()
                                            : "open###open";
  if ((ImGui::Button(label) || entered_) && !files.empty()) {
    if (exists && !asks)
      overwrite_ = files[0];  // once more to be sure
    else
      result = files;
  }
  ImGui::SameLine();
  if (ImGui::Button("cancel")) open_ = false;
  if (mode_ == Mode::open && !extensions_.empty()) {
    ImGui::SameLine();
    if (ImGui::Checkbox("all files", &all_files_)) list();
  }
  ImGui::SameLine();
  if (asks)
    ImGui::TextUnformatted("a file of that name is there");
  else if (mode_ == Mode::save && !extensions_.empty())
    ImGui::TextUnformatted(fmt::format("{}", fmt::join(extensions_, " ")).c_str());
  if (result) open_ = false;
  if (!open_) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  return result;
}

}  // namespace nacre
