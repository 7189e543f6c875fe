// Nacre: the brick octree of a flow on the graphics device.
#include "engine/render/octree_texture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace nacre {

OctreeTexture::OctreeTexture(const OctreeLookup& lookup, std::size_t page)
    : node_(lookup.node, page),
      layer_(lookup.layer, page),
      level_start_(lookup.level_start.begin(), lookup.level_start.end()),
      levels_(lookup.levels),
      origin_(lookup.origin),
      cell_size_(lookup.cell_size) {
  level_start_.resize(std::size_t(levels_) + 1);
}

std::string OctreeTexture::prelude() const {
  std::vector<std::string> starts;
  for (const std::uint32_t start : level_start_) starts.push_back(fmt::format("{}u", start));
  return fmt::format("#define TEXTURED\n#define OCTREE\n#define LEVELS {}\nconst uint level_start[] = uint[]({});\n",
                     levels_, fmt::join(starts, ", ")) +
         node_.source("node") + layer_.source("layer");
}

int OctreeTexture::bind(const Program& program, const BufferTexture& shown, int unit) const {
  unit = node_.bind(program, "node", unit);
  unit = layer_.bind(program, "layer", unit);
  shown.bind(unit);
  program.set("shown", unit);
  return unit + 1;
}

}  // namespace nacre
