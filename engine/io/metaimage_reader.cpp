// Nacre: reads MetaImage: a text header, then the values behind it or in one other file. Ours, since VTK makes up the
// values that a damaged file lacks, and leaves out where the axes point to.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

#include "engine/io/file_bytes.hpp"
#include "engine/io/mapped_values.hpp"
#include "engine/io/text_cursor.hpp"
#include "engine/io/volume_geometry.hpp"
#include "engine/io/volume_readers.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_metaimage_header = 1 << 16;
constexpr std::string_view last_key = "ElementDataFile";

std::string_view trimmed_view(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The lines KEY = VALUE, up to that of the data file.
class MetaImageHeader {
 public:
  explicit MetaImageHeader(const fs::path& path) : path_(path), text_(longest_metaimage_header, '\0') {
    std::ifstream file(path, std::ios::binary);
    file.read(text_.data(), std::streamsize(text_.size()));
    text_.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
    for (std::string_view rest = text_; !rest.empty() && !fields_.count(std::string(last_key));) {
      const std::string_view line = rest.substr(0, rest.find('\n'));
      rest.remove_prefix(std::min(rest.size(), line.size() + 1));
      size_ = text_.size() - rest.size();
      const std::size_t equals = line.find('=');
      if (equals == line.npos) continue;
      fields_[std::string(trimmed_view(line.substr(0, equals)))] = trimmed_view(line.substr(equals + 1));
    }
    if (!fields_.count("NDims") || !fields_.count(std::string(last_key)))
      fail_reading(path, "it has no MetaImage header", "check that it is MetaImage");
  }

  std::size_t size() const { return size_; }  ///< bytes before the values of a LOCAL file

  /// The value of the first of these keys that is there; empty where none is.
  std::string_view text(std::initializer_list<const char*> keys) const {
    for (const char* key : keys)
      if (const auto found = fields_.find(key); found != fields_.end()) return found->second;
    return {};
  }

  bool is_true(std::initializer_list<const char*> keys, bool otherwise) const {
    const std::string_view value = text(keys);
    if (value.empty()) return otherwise;
    const char first = char(std::tolower(static_cast<unsigned char>(value[0])));
    const bool yes = first == 't' || first == '1' || first == 'y';
    if (!yes && first != 'f' && first != '0' && first != 'n')
      fail_reading(path_, fmt::format("its header says {} = {}", *keys.begin(), value.substr(0, 60)),
                   "say True or False");
    return yes;
  }

  /// N numbers. False where none of the keys is there. Throws Error where they are not N numbers.
  template <std::size_t N>
  bool numbers(std::initializer_list<const char*> keys, std::array<double, N>& values) const {
    const std::string_view value = text(keys);
    if (value.empty()) return false;
    TextCursor cursor(value);
    for (double& number : values)
      if (!cursor.number(number))
        fail_reading(path_, fmt::format("its header says {} = {}", *keys.begin(), value.substr(0, 60)));
    return true;
  }

  std::int64_t integer(const char* key, std::int64_t otherwise) const {
    const std::string_view value = text({key});
    std::int64_t number = otherwise;
    TextCursor cursor(value);
    if (!value.empty() && !(cursor.integer(number) && cursor.at_end()))
      fail_reading(path_, fmt::format("its header says {} = {}", key, value.substr(0, 60)));
    return number;
  }

 private:
  const fs::path& path_;
  std::string text_;
  std::size_t size_ = 0;
  std::map<std::string, std::string_view> fields_;
};

/// Calls `use(zero)` with a zero of the C++ type of this name. False if it is no single number.
template <class Use>
bool with_element_type(std::string_view name, Use use) {
  if (name == "MET_CHAR") return use(std::int8_t{}), true;
  if (name == "MET_UCHAR") return use(std::uint8_t{}), true;
  if (name == "MET_SHORT") return use(std::int16_t{}), true;
  if (name == "MET_USHORT") return use(std::uint16_t{}), true;
  if (name == "MET_INT" || name == "MET_LONG") return use(std::int32_t{}), true;  // its long has 4 bytes
  if (name == "MET_UINT" || name == "MET_ULONG") return use(std::uint32_t{}), true;
  if (name == "MET_LONG_LONG") return use(std::int64_t{}), true;
  if (name == "MET_ULONG_LONG") return use(std::uint64_t{}), true;
  if (name == "MET_FLOAT") return use(float{}), true;
  if (name == "MET_DOUBLE") return use(double{}), true;
  return false;
}

void set_dimensions(Volume& volume, const MetaImageHeader& header, std::size_t bytes_per_voxel, const fs::path& path) {
  const std::int64_t rank = header.integer("NDims", 0);
  if (rank != 3 && rank != 4) fail_reading(path, fmt::format("it has {} dimensions", rank), "open a volume");
  std::array<std::int64_t, 4> dims{0, 0, 0, 1};
  TextCursor cursor(header.text({"DimSize"}));
  for (std::int64_t i = 0; i < rank; ++i)
    if (!cursor.integer(dims[std::size_t(i)])) fail_reading(path, "its header gives no DimSize");
  if (dims[3] != 1)
    fail_reading(path, fmt::format("it has {} entries along its dimension 4", dims[3]), "extract one of them");
  if (const std::int64_t channels = header.integer("ElementNumberOfChannels", 1); channels != 1)
    fail_reading(path, fmt::format("it has {} values per voxel", channels), "open one component at a time");
  set_dims(volume, {dims[0], dims[1], dims[2]}, bytes_per_voxel, path);
}

/// Row a of the matrix is the direction of axis a.
template <std::size_t Rank>
void set_frame(Volume& volume, const MetaImageHeader& header, const fs::path& path) {
  std::array<double, Rank> spacing, origin{};
  std::array<double, Rank * Rank> matrix{};
  spacing.fill(1);
  for (std::size_t i = 0; i < Rank; ++i) matrix[i * Rank + i] = 1;
  if (!header.numbers({"ElementSpacing", "ElementSize"}, spacing))
    volume.warnings.push_back("The file gives no spacing; 1 is assumed.");
  header.numbers({"Offset", "Position", "Origin"}, origin);
  header.numbers({"TransformMatrix", "Orientation", "Rotation"}, matrix);
  std::array<Vec3d, 3> steps;
  for (int axis = 0; axis < 3; ++axis) {
    volume.origin[axis] = origin[std::size_t(axis)];
    for (int row = 0; row < 3; ++row)
      steps[axis][row] = spacing[std::size_t(axis)] * matrix[std::size_t(axis) * Rank + std::size_t(row)];
  }
  if (!is_finite(volume.origin)) fail_reading(path, "its origin is not a number", "correct its header");
  set_steps(volume, steps, path);
}

struct Stored {
  fs::path file;
  std::size_t offset = 0;  ///< where the values begin
};

Stored find_values(const MetaImageHeader& header, const fs::path& path) {
  const std::string name(header.text({last_key.data()}));
  if (name == "LOCAL" || name == "Local" || name == "local") return {path, header.size()};
  if (name.starts_with("LIST") || name.find('%') != name.npos)
    fail_reading(path, "its values are spread over several files", "write it as one file");
  const fs::path file = fs::path(name).is_absolute() ? fs::path(name) : path.parent_path() / name;
  std::error_code code;
  if (!fs::is_regular_file(file, code))
    fail_reading(path, fmt::format("its data file {} is missing", name), "put it beside the header");
  const std::int64_t skip = header.integer("HeaderSize", 0);
  if (skip < -1 || skip > std::int64_t(1) << 50)
    fail_reading(path, fmt::format("its header says HeaderSize = {}", skip));
  return {file, skip < 0 ? std::size_t(-1) : std::size_t(skip)};
}

/// How many bytes the values take in their file.
std::size_t stored_size(const MetaImageHeader& header, bool packed, std::size_t unpacked, const Stored& stored,
                        const fs::path& path) {
  if (!packed || stored.offset != std::size_t(-1)) return unpacked;
  const std::int64_t size = header.integer("CompressedDataSize", 0);
  if (size <= 0)
    fail_reading(path, "it has HeaderSize = -1 and CompressedData = True, and no CompressedDataSize",
                 "give the size of the data file's header in bytes");
  return std::size_t(size);
}

/// Some bytes of a file.
struct StoredPart {
  std::size_t from = 0, size = 0;
};

/// From the offset to the file's end; its last `needed` bytes for the offset -1.
StoredPart stored_part(const Stored& stored, std::size_t needed, const fs::path& path) {
  std::error_code code;
  const std::uintmax_t size = fs::file_size(stored.file, code);
  const std::uintmax_t from =
      stored.offset != std::size_t(-1) ? stored.offset : size - std::min<std::uintmax_t>(size, needed);
  if (code || from > size) fail_reading(path, "it ends before its values begin");
  return {std::size_t(from), std::size_t(size - from)};
}

void read_part(const Stored& stored, const StoredPart& part, char* to, const fs::path& path) {
  std::ifstream file(stored.file, std::ios::binary);
  file.seekg(std::streamoff(part.from));
  file.read(to, std::streamsize(part.size));
  if (std::size_t(std::max<std::streamsize>(file.gcount(), 0)) != part.size)
    fail_reading(path, "reading stopped before the end of the file");
}

std::string stored_bytes(const Stored& stored, const StoredPart& part, const fs::path& path) {
  std::string bytes(part.size, '\0');
  read_part(stored, part, bytes.data(), path);
  return bytes;
}

/// Unpacks one zlib (or gzip) stream into exactly `size` bytes.
void unpack(const std::string& packed, char* out, std::size_t size, const fs::path& path) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 32) != Z_OK) fail_reading(path, "zlib could not start");
  struct End {
    z_stream* stream;
    ~End() { inflateEnd(stream); }
  } end{&stream};
  std::size_t used = 0, filled = 0;
  for (int state = Z_OK; state != Z_STREAM_END;) {
    const uInt in = uInt(std::min<std::size_t>(packed.size() - used, 1u << 30));
    const uInt room = uInt(std::min<std::size_t>(size - filled, 1u << 30));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + used));
    stream.avail_in = in;
    stream.next_out = reinterpret_cast<Bytef*>(out + filled);
    stream.avail_out = room;
    state = inflate(&stream, Z_NO_FLUSH);
    used += in - stream.avail_in;
    filled += room - stream.avail_out;
    const bool stuck = state == Z_BUF_ERROR || (in == stream.avail_in && room == stream.avail_out);
    if (state != Z_STREAM_END && (stuck || state != Z_OK))
      fail_reading(path,
                   state == Z_DATA_ERROR ? "its packed values are damaged" : "its packed values end too early or late");
  }
  if (filled != size) fail_reading(path, fmt::format("it needs {} bytes of values but contains {}", size, filled));
}

template <class T>
std::vector<T> parse_values(const std::string& text, std::size_t count, const fs::path& path) {
  std::vector<T> values(std::min(count, text.size()));
  TextCursor cursor(text);
  double number = 0;
  for (T& value : values) {
    if (!cursor.number(number)) fail_reading(path, "its text has fewer numbers than voxels");
    if constexpr (std::is_integral_v<T>)
      if (!(number >= double(std::numeric_limits<T>::lowest()) && number <= double(std::numeric_limits<T>::max())))
        fail_reading(path, fmt::format("its text has {}, which is out of range for its type", number));
    value = T(number);
  }
  if (values.size() != count) fail_reading(path, "its text has fewer numbers than voxels");
  if (!cursor.at_end()) fail_reading(path, "its text has more numbers than voxels");
  return values;
}

template <class T>
VoxelArray<T> metaimage_values(const MetaImageHeader& header, Volume& volume, Values how, const fs::path& path) {
  const std::size_t count = volume.voxels();
  const bool packed = header.is_true({"CompressedData"}, false);
  const std::size_t needed = count * sizeof(T);
  const Stored stored = find_values(header, path);
  const StoredPart part = stored_part(stored, stored_size(header, packed, needed, stored, path), path);
  if (!header.is_true({"BinaryData"}, true)) return parse_values<T>(stored_bytes(stored, part, path), count, path);
  check_stored(part.size, needed, packed ? double(largest_gzip_ratio) : 1.0, path);
  warn_of_rest(volume, !packed && part.size > needed);
  const bool big = header.is_true({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}, false);
  const bool swapped = sizeof(T) > 1 && big != (std::endian::native == std::endian::big);
  if (!packed && !swapped && can_map(how, part.from, count, sizeof(T)))
    return mapped_values<T>(stored.file, part.from, count);
  std::vector<T> values(count);
  if (packed)
    unpack(stored_bytes(stored, part, path), reinterpret_cast<char*>(values.data()), needed, path);
  else
    read_part(stored, {part.from, needed}, reinterpret_cast<char*>(values.data()), path);
  if (swapped) swap_bytes(values);
  return values;
}

Volume open_metaimage(const fs::path& path, Values how) {
  const MetaImageHeader header(path);
  Volume volume;
  const std::string_view type = header.text({"ElementType"});
  const bool known = with_element_type(type, [&](auto zero) {
    set_dimensions(volume, header, sizeof(zero), path);
    header.integer("NDims", 0) == 3 ? set_frame<3>(volume, header, path) : set_frame<4>(volume, header, path);
    volume.values = metaimage_values<decltype(zero)>(header, volume, how, path);
  });
  if (!known) fail_reading(path, fmt::format("its values are of type '{}'", type), "convert it to integers or floats");
  return volume;
}

}  // namespace

Volume read_metaimage(const fs::path& path) { return open_metaimage(path, Values::read); }
Volume map_metaimage(const fs::path& path) { return open_metaimage(path, Values::mapped); }

}  // namespace nacre
