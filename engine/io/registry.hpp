// Nacre: which reader reads which file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/io/raw_mesh.hpp"

namespace nacre {

/// A format of surfaces that this program reads itself.
struct SurfaceFormat {
  std::string name;                     ///< "PLY"
  std::vector<std::string> extensions;  ///< lower case, without the dot
  std::function<RawMesh(std::string bytes, const std::filesystem::path& path)> read;
};

/// All of these formats.
const std::vector<SurfaceFormat>& surface_formats();

/// The format that has this extension, or nullptr.
const SurfaceFormat* find_format(const std::string& extension);

/// The format that the content looks like, or nullptr. A guess from the first bytes.
const SurfaceFormat* sniff_format(const std::string& bytes);

/// A file read by the reader of its extension or, if that has none, by the format of its content.
struct RawFile {
  const SurfaceFormat* format = nullptr;
  RawMesh mesh;
};

/// Reads one file. Throws Error if no reader accepts it or the reader fails; if content and extension disagree, the
/// Error says so.
RawFile read_raw(const std::filesystem::path& path);

/// The same for content that is already in memory; `path` is used for its extension and for messages.
RawFile read_raw(std::string bytes, const std::filesystem::path& path);

/// Advice for a file whose extension and content suggest different formats; empty if they agree.
std::string mismatch_advice(const std::string& bytes, const SurfaceFormat& format);

/// Every extension that `read_raw` knows, sorted.
std::vector<std::string> own_extensions();

}  // namespace nacre
