// Nacre: the files that other files name.
#include "engine/io/named_files.hpp"

#include <algorithm>
#include <fstream>
#include <string>

#include "engine/io/file_bytes.hpp"
#include "engine/io/file_steps.hpp"
#include "engine/io/nrrd_header.hpp"
#include "engine/io/vtk_xml.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// The pieces of .pvtp and .pvtu.
void add_pieces(const fs::path& path, std::vector<fs::path>& named) {
  const VtkXmlFile file(read_file(path), path);
  for (const pugi::xml_node piece : file.dataset().children("Piece"))
    if (const std::string source = piece.attribute("Source").value(); !source.empty())
      named.push_back(path.parent_path() / source);
}

/// What follows "ElementDataFile =".
void add_metaimage_data(const fs::path& path, std::vector<fs::path>& named) {
  std::ifstream stream(path, std::ios::binary);
  for (std::string line; std::getline(stream, line) && line.size() < 4096;) {
    if (!line.starts_with("ElementDataFile")) continue;
    const std::size_t first = line.find_first_not_of(" \t=", 15), last = line.find_last_not_of(" \t\r");
    if (first == line.npos) return;
    const fs::path file = path.parent_path() / line.substr(first, last + 1 - first);
    std::error_code code;
    if (fs::is_regular_file(file, code)) named.push_back(file);
    return;
  }
}

/// .hdr and .img belong together.
void add_half(const fs::path& path, const char* other, std::vector<fs::path>& named) {
  for (const char* end : {"", ".gz"}) {
    fs::path half = path;
    if (half.extension() == ".gz") half.replace_extension();
    half.replace_extension(other) += end;
    std::error_code code;
    if (fs::is_regular_file(half, code)) named.push_back(half);
  }
}

}  // namespace

std::vector<fs::path> named_files(const std::vector<fs::path>& inputs) {
  std::vector<fs::path> named;
  for (const fs::path& path : inputs) {
    const std::string extension = format_extension(path);
    if (is_file_list(path)) {
      for (const FileStep& step : find_steps(path).steps)
        named.insert(named.end(), step.parts.begin(), step.parts.end());
    } else if (extension == "pvtp" || extension == "pvtu") {
      add_pieces(path, named);
    } else if (extension == "nhdr") {
      const std::vector<fs::path> files = look_into_nrrd(path).files;
      named.insert(named.end(), files.begin(), files.end());
    } else if (extension == "mhd") {
      add_metaimage_data(path, named);
    } else if (extension == "hdr" || extension == "img") {
      add_half(path, extension == "hdr" ? ".img" : ".hdr", named);
    }
  }
  std::sort(named.begin(), named.end());
  named.erase(std::unique(named.begin(), named.end()), named.end());
  return named;
}

}  // namespace nacre
