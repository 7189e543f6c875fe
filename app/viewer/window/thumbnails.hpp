// Nacre: small pictures of what was opened, kept between runs beside the list of recent files.
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "engine/gl/texture.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

class Thumbnails {
 public:
  static constexpr int width = 96, height = 72;

  Thumbnails();  ///< in $XDG_STATE_HOME/nacre/thumbnails (~/.local/state/nacre/thumbnails)
  explicit Thumbnails(std::filesystem::path folder);

  /// Keeps a picture of that size as what a file shows. A folder that cannot be written is no matter.
  void keep(const std::filesystem::path& file, const Image& picture);
  /// The texture with the picture of a file, while an OpenGL context is current; 0: there is none.
  GLuint texture(const std::filesystem::path& file);
  /// Removes the pictures of all files but these.
  void keep_only(const std::vector<std::filesystem::path>& files);
  /// Before the context goes.
  void drop_textures() { textures_.clear(); }

 private:
  std::filesystem::path picture_of(const std::filesystem::path& file) const;

  std::filesystem::path folder_;
  std::map<std::filesystem::path, ImageTexture> textures_;  ///< by picture; without a size: there is none
};

}  // namespace nacre
