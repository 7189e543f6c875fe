// Nacre: draws images over a frame.
#include "engine/render/overlay_pass.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "engine/render/blended.hpp"
namespace nacre {
namespace {

using Tile = std::array<float, 2>;  // upper left corner, pixels
constexpr int edge = 32;

bool is_clear(const Image& image, int left, int top) {
  for (int y = top; y < std::min(top + edge, image.height); ++y)
    for (int x = left; x < std::min(left + edge, image.width); ++x)
      if (image.at(x, y)[3] > 0) return false;
  return true;
}

std::vector<Tile> used_tiles(const Image& image) {
  std::vector<Tile> tiles;
  for (int y = 0; y < image.height; y += edge)
    for (int x = 0; x < image.width; x += edge)
      if (!is_clear(image, x, y)) tiles.push_back({float(x), float(y)});
  return tiles;
}

}  // namespace

OverlayPass::OverlayPass() : program_("overlay.vert", "overlay.frag") {
  glCreateVertexArrays(1, &array_);
  glEnableVertexArrayAttrib(array_, 0);
  glVertexArrayAttribFormat(array_, 0, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array_, 0, 0);
  glVertexArrayBindingDivisor(array_, 0, 1);
}

OverlayPass::~OverlayPass() { glDeleteVertexArrays(1, &array_); }

void OverlayPass::set_image(const Image& image) {
  const std::vector<Tile> tiles = image.pixels.empty() ? std::vector<Tile>() : used_tiles(image);
  tile_count_ = GLsizei(tiles.size());
  if (tiles.empty()) return;
  if (image.width == texture_.width() && image.height == texture_.height())
    texture_.update(image);
  else
    texture_ = ImageTexture(image);
  tiles_ = Buffer::of<Tile>(tiles);
  glVertexArrayVertexBuffer(array_, 0, tiles_.id(), 0, sizeof(Tile));
}

void OverlayPass::draw(const View& view) const {
  if (tile_count_ == 0) return;
  texture_.bind(0);
  program_.set("image", 0);
  program_.set("edge", float(edge));
  program_.set("image_size", std::array<float, 2>{float(texture_.width()), float(texture_.height())});
  program_.set("picture_size", std::array<float, 2>{float(view.width), float(view.height)});
  program_.use();
  glBindVertexArray(array_);
  glDisable(GL_DEPTH_TEST);
  const Blended blended;
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, tile_count_);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace nacre
