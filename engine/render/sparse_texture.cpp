// Nacre: the look-up arrays of the flow's grid on the graphics device.
#include "engine/render/sparse_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "compute/device/error.hpp"
#include "compute/embedding/refined_grid.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_pages = 8;  // of one array: three arrays and the values fit into 32 texture units

/// Reads the arrays of the look-up as RefinedGridView does.
class LookupReader {
 public:
  explicit LookupReader(const SparseLookup& lookup) : l_(lookup) {}

  std::uint32_t block_at(const Int3& cell) const {
    const int sub = l_.subcells;
    const Int3 brick{cell.x / sub, cell.y / sub, cell.z / sub};
    if (brick.x >= l_.bricks.x || brick.y >= l_.bricks.y || brick.z >= l_.bricks.z) return none;
    const std::uint32_t b = l_.brick_index[(std::size_t(brick.z) * l_.bricks.y + std::size_t(brick.y)) * l_.bricks.x +
                                           std::size_t(brick.x)];
    if (b == none) return none;
    const Int3 in = cell - brick * Int3(sub);
    return l_.block[std::size_t(b) * sub * sub * sub + std::size_t((in.z * sub + in.y) * sub + in.x)];
  }

  /// Fills the rimmed block of the closest-point cell at `cell`.
  void fill(const Int3& cell, std::uint32_t* to) const {
    const int r = l_.refine;
    std::array<std::uint32_t, 8> blocks;
    for (int k = 0; k < 8; ++k) blocks[std::size_t(k)] = block_at(cell + Int3(k & 1, k >> 1 & 1, k >> 2));
    for (int z = 0; z <= r; ++z)
      for (int y = 0; y <= r; ++y)
        for (int x = 0; x <= r; ++x) {
          const std::uint32_t b = blocks[std::size_t((x == r) | (y == r) << 1 | (z == r) << 2)];
          const std::size_t in = std::size_t(((z % r) * r + y % r) * r + x % r);
          const std::uint32_t texel = b == none ? none : l_.texel[std::size_t(b) * r * r * r + in];
          *to++ = texel == none ? none : texel & ~RefinedGridView::extended;
        }
  }

 private:
  const SparseLookup& l_;
};

}  // namespace

std::vector<std::uint32_t> with_rims(const SparseLookup& lookup) {
  const std::size_t own = std::size_t(lookup.refine) * lookup.refine * lookup.refine;
  const std::size_t rimmed = std::size_t(lookup.refine + 1) * (lookup.refine + 1) * (lookup.refine + 1);
  std::vector<std::uint32_t> texels(lookup.texel.size() / own * rimmed, none);
  const LookupReader reader(lookup);
  const Int3 cells = lookup.bricks * Int3(lookup.subcells);
  const int sub = lookup.subcells;
  for (int bz = 0; bz < cells.z; bz += sub)
    for (int by = 0; by < cells.y; by += sub)
      for (int bx = 0; bx < cells.x; bx += sub) {
        const std::size_t at = (std::size_t(bz / sub) * lookup.bricks.y + std::size_t(by / sub)) * lookup.bricks.x;
        if (lookup.brick_index[at + std::size_t(bx / sub)] == none) continue;
        for (int k = 0; k < sub * sub * sub; ++k) {
          const Int3 cell(bx + k % sub, by + k / sub % sub, bz + k / (sub * sub));
          const std::uint32_t block = reader.block_at(cell);
          if (block != none) reader.fill(cell, &texels[block * rimmed]);
        }
      }
  return texels;
}

PagedArray::PagedArray(std::span<const std::uint32_t> values, std::size_t most) {
  const std::size_t page = std::bit_floor(most > 0 ? most : BufferTexture::most_elements());
  shift_ = std::countr_zero(page);
  const std::size_t count = std::max<std::size_t>(1, (values.size() + page - 1) / page);
  if (count > most_pages)
    throw Error("the texture is too large for the graphics device",
                fmt::format("{} MiB of look-up arrays", values.size_bytes() >> 20), "lower --resolution");
  static constexpr std::uint32_t nothing[] = {none};
  for (std::size_t k = 0; k < count; ++k) {
    const auto part = values.subspan(std::min(values.size(), k * page), std::min(page, values.size() - k * page));
    Page& made = pages_.emplace_back();
    made.buffer = Buffer::of<std::uint32_t>(part.empty() ? std::span<const std::uint32_t>(nothing) : part);
    made.texture = BufferTexture(made.buffer, GL_R32UI);
  }
}

std::string PagedArray::source(std::string_view name) const {
  std::string samplers, body;
  for (std::size_t k = 0; k < pages_.size(); ++k) {
    samplers += fmt::format("uniform usamplerBuffer {}_{};\n", name, k);
    const std::string read =
        fmt::format("return texelFetch({}_{}, int(i & {}u)).r;", name, k, (std::uint64_t(1) << shift_) - 1);
    body += k + 1 < pages_.size() ? fmt::format("  if (i >> {} == {}u) {}\n", shift_, k, read) : "  " + read + "\n";
  }
  return fmt::format("{}uint fetch_{}(uint i) {{\n{}}}\n", samplers, name, body);
}

int PagedArray::bind(const Program& program, std::string_view name, int unit) const {
  for (std::size_t k = 0; k < pages_.size(); ++k, ++unit) {
    pages_[k].texture.bind(unit);
    program.set(fmt::format("{}_{}", name, k).c_str(), unit);
  }
  return unit;
}

SparseTexture::SparseTexture(const SparseLookup& lookup, std::span<const std::uint32_t> rimmed, std::size_t page)
    : brick_(lookup.brick_index, page),
      block_(lookup.block, page),
      texel_(rimmed, page),
      bricks_(lookup.bricks),
      subcells_(lookup.subcells),
      refine_(lookup.refine),
      origin_(lookup.origin),
      cell_size_(lookup.cell_size) {}

std::string SparseTexture::prelude() const {
  return fmt::format("#define TEXTURED\n#define SUB {}\n#define REFINE {}\n", subcells_, refine_) +
         brick_.source("brick") + block_.source("block") + texel_.source("texel");
}

int SparseTexture::bind(const Program& program, const BufferTexture& shown, int unit) const {
  unit = brick_.bind(program, "brick", unit);
  unit = block_.bind(program, "block", unit);
  unit = texel_.bind(program, "texel", unit);
  shown.bind(unit);
  program.set("shown", unit);
  program.set("bricks", std::array<int, 3>{bricks_.x, bricks_.y, bricks_.z});
  return unit + 1;
}

}  // namespace nacre
