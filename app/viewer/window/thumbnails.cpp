// Nacre: small pictures of what was opened.
#include "app/viewer/window/thumbnails.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "app/viewer/window/recent_files.hpp"
#include "compute/device/error.hpp"
#include "engine/picture/png.hpp"

namespace nacre {

namespace fs = std::filesystem;

Thumbnails::Thumbnails() : Thumbnails(state_folder().empty() ? fs::path() : state_folder() / "thumbnails") {}

Thumbnails::Thumbnails(fs::path folder) : folder_(std::move(folder)) {}

fs::path Thumbnails::picture_of(const fs::path& file) const {
  std::error_code ignored;
  return folder_ / fmt::format("{:016x}.png", std::hash<std::string>()(fs::absolute(file, ignored).string()));
}

void Thumbnails::keep(const fs::path& file, const Image& picture) {
  if (folder_.empty()) return;
  std::error_code ignored;
  fs::create_directories(folder_, ignored);
  textures_.erase(picture_of(file));
  try {
    write_png(picture_of(file), picture);
  } catch (const Error&) {
  }
}

GLuint Thumbnails::texture(const fs::path& file) {
  if (folder_.empty()) return 0;
  const auto known = textures_.find(picture_of(file));
  if (known != textures_.end()) return known->second.width() > 0 ? known->second.id() : 0;
  ImageTexture& texture = textures_[picture_of(file)];
  std::error_code ignored;
  if (!fs::exists(picture_of(file), ignored)) return 0;
  try {
    const Image picture = read_png(picture_of(file));
    if (picture.width == width && picture.height == height) texture = ImageTexture(picture);
  } catch (const Error&) {
  }
  return texture.width() > 0 ? texture.id() : 0;
}

void Thumbnails::keep_only(const std::vector<fs::path>& files) {
  std::set<fs::path> wanted;
  for (const fs::path& file : files) wanted.insert(picture_of(file));
  std::error_code failed;
  for (fs::directory_iterator entry(folder_, failed), end; !failed && entry != end; entry.increment(failed))
    if (entry->path().extension() == ".png" && !wanted.contains(entry->path())) {
      std::error_code ignored;
      fs::remove(entry->path(), ignored);
    }
}

}  // namespace nacre
