// Nacre: writes volumes as NRRD.
#include "engine/io/nrrd_writer.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <type_traits>
#include <variant>

#include "compute/device/error.hpp"
#include "engine/system/extension.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace {

static_assert(std::endian::native == std::endian::little, "the values are written as they lie in memory");

std::string vector_text(const Vec3d& v) { return fmt::format("({:.17g},{:.17g},{:.17g})", v.x, v.y, v.z); }

std::string header(const Volume& volume, bool compressed) {
  std::string text = fmt::format("NRRD0004\ntype: {}\ndimension: 3\n", value_type_name(volume.values));
  text += volume.space.empty() ? "space dimension: 3\n" : fmt::format("space: {}\n", volume.space);
  text += fmt::format("sizes: {} {} {}\nspace directions:", volume.dims.x, volume.dims.y, volume.dims.z);
  for (int axis = 0; axis < 3; ++axis) text += " " + vector_text(volume.axes[axis] * volume.spacing[axis]);
  text += "\nkinds: domain domain domain\n";
  if (std::visit([](const auto& values) { return sizeof(values[0]); }, volume.values) > 1) text += "endian: little\n";
  return text +
         fmt::format("encoding: {}\nspace origin: {}\n\n", compressed ? "gzip" : "raw", vector_text(volume.origin));
}

/// Writes one gzip member.
class GzipWriter {
 public:
  explicit GzipWriter(OutputFile& out) : out_(out) {
    constexpr int gzip = 16 + MAX_WBITS;
    if (deflateInit2(&stream_, Z_BEST_SPEED, Z_DEFLATED, gzip, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  }
  ~GzipWriter() { deflateEnd(&stream_); }
  GzipWriter(const GzipWriter&) = delete;
  GzipWriter& operator=(const GzipWriter&) = delete;

  void write(const unsigned char* data, std::size_t bytes) {
    do {
      const std::size_t piece = std::min<std::size_t>(bytes, 1u << 30);
      stream_.next_in = const_cast<unsigned char*>(data);
      stream_.avail_in = static_cast<unsigned>(piece);
      data += piece;
      bytes -= piece;
      do {
        stream_.next_out = buffer_.data();
        stream_.avail_out = static_cast<unsigned>(buffer_.size());
        deflate(&stream_, bytes == 0 ? Z_FINISH : Z_NO_FLUSH);
        out_.write(buffer_.data(), buffer_.size() - stream_.avail_out);
      } while (stream_.avail_out == 0);
    } while (bytes > 0);
  }

 private:
  OutputFile& out_;
  z_stream stream_{};
  std::array<unsigned char, 1 << 16> buffer_;
};

}  // namespace

void write_nrrd(const std::filesystem::path& file, const Volume& volume) {
  if (lower_extension(file) != ".nrrd")
    throw Error("cannot write a volume to " + file.string(), "its extension is not .nrrd", "name it *.nrrd");
  std::visit(
      [&](const auto& values) {
        constexpr bool whole = std::is_integral_v<std::decay_t<decltype(values[0])>>;
        OutputFile out(file);
        out.write(header(volume, whole));
        const std::size_t bytes = values.size() * sizeof(values[0]);
        if (whole)
          GzipWriter(out).write(reinterpret_cast<const unsigned char*>(values.data()), bytes);
        else
          out.write(values.data(), bytes);
        out.commit();
      },
      volume.values);
}

}  // namespace nacre
