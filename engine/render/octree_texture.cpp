// Nacre: an octree of a flow on the graphics device.
#include "engine/render/octree_texture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace nacre {

OctreeTexture::OctreeTexture(const OctreeLookup& lookup, std::size_t page)
    : node_(lookup.child.empty() ? lookup.node : lookup.child, page),
      layer_(lookup.child.empty() ? PagedArray(lookup.layer, page) : PagedArray()),
      level_start_(lookup.level_start.begin(), lookup.level_start.end()),
      thesis_nodes_(lookup.child.size() / 8),
      levels_(lookup.levels),
      origin_(lookup.origin),
      cell_size_(lookup.cell_size) {
  level_start_.resize(std::size_t(levels_) + 1);
}

std::string OctreeTexture::prelude() const {
  const std::string tree =
      fmt::format("#define TEXTURED\n#define OCTREE\n#define LEVELS {}\n", levels_) + node_.source("node");
  if (thesis_nodes_ > 0) return tree + fmt::format("#define SOURCE_OCTREE\n#define ROOT {}u\n", thesis_nodes_ - 1);
  std::vector<std::string> starts;
  for (const std::uint32_t start : level_start_) starts.push_back(fmt::format("{}u", start));
  return tree + fmt::format("const uint level_start[] = uint[]({});\n", fmt::join(starts, ", ")) +
         layer_.source("layer");
}

int OctreeTexture::bind(const Program& program, const BufferTexture& shown, int unit) const {
  unit = node_.bind(program, "node", unit);
  unit = layer_.bind(program, "layer", unit);
  shown.bind(unit);
  program.set("shown", unit);
  return unit + 1;
}

}  // namespace nacre
