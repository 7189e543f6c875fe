// The shown value at a position of the surface, from an octree. LEVELS, the tables and their fetches are in the
// prelude.
uniform samplerBuffer shown;  // a value per cell, then a mean per brick
uniform int values;           // how many cells have a value; -1: no means follow

const uint nothing = 0xffffffffu;

#ifdef SOURCE_OCTREE
// Descends from the root to a cell, in the octree of the thesis.
uint number_at(ivec3 cell) {
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(8 << LEVELS)))) return nothing;
  uint at = ROOT;
  for (int shift = LEVELS + 2; shift >= 0 && at != nothing; --shift) {
    ivec3 bit = cell >> shift & 1;
    at = fetch_node(8u * at + uint(bit.x | bit.y << 1 | bit.z << 2));
  }
  return at;
}
#else
// Node, brick, layer, value (BrickOctreeView, compute/embedding/brick_octree.hpp): descends from the root.
uint brick_at(ivec3 b) {
  if (any(lessThan(b, ivec3(0))) || any(greaterThanEqual(b, ivec3(1 << LEVELS)))) return nothing;
  uint at = 0u;
  for (int level = 0; level < LEVELS; ++level) {
    uint node = 2u * (level_start[level] + at);
    ivec3 bit = b >> (LEVELS - 1 - level) & 1;
    uint child = uint(bit.x | bit.y << 1 | bit.z << 2), children = fetch_node(node + 1u);
    if ((children >> child & 1u) == 0u) return nothing;
    at = fetch_node(node) + uint(bitCount(children & ((1u << child) - 1u)));
  }
  return at;
}

// The number of the surface cell at `in_brick`, or nothing.
uint cell_of(uint brick, ivec3 in_brick) {
  uint layer = 24u * brick + 3u * uint(in_brick.z);
  uint low = fetch_layer(layer), at = uint(8 * (in_brick.y & 3) + in_brick.x), below = (1u << at) - 1u;
  if (in_brick.y < 4) {
    if ((low >> at & 1u) == 0u) return nothing;
    return fetch_layer(layer + 2u) + uint(bitCount(low & below));
  }
  uint high = fetch_layer(layer + 1u);
  if ((high >> at & 1u) == 0u) return nothing;
  return fetch_layer(layer + 2u) + uint(bitCount(low) + bitCount(high & below));
}

// The brick of the last cell is remembered.
ivec3 last = ivec3(-1);
uint brick = nothing;

uint number_at(ivec3 cell) {
  ivec3 in_bricks = cell >> 3;
  if (in_bricks != last) brick = brick_at(in_bricks);
  last = in_bricks;
  return brick == nothing ? nothing : cell_of(brick, cell & 7);
}
#endif

// Linear among the cells around `place` (in texture cells) that have a value; -1 if there is none.
float fine_at(vec3 place) {
  vec3 corner = floor(place - 0.5);
  vec3 f = place - 0.5 - corner;
  float sum = 0.0, weight = 0.0;
  for (int k = 0; k < 8; ++k) {
    ivec3 bit = ivec3(k & 1, k >> 1 & 1, k >> 2);
    uint number = number_at(ivec3(corner) + bit);
    if (number == nothing) continue;
    vec3 share = mix(1.0 - f, f, bvec3(bit));
    float w = share.x * share.y * share.z;
    sum += w * texelFetch(shown, int(number)).r;
    weight += w;
  }
  return weight > 0.0 ? sum / weight : -1.0;
}

#ifdef SOURCE_OCTREE
const float mean_width = 0.0;  // there are none
float mean_at(vec3 place) { return -1.0; }
#else
const float mean_width = 8.0;  // texture cells

// The same among the means of bricks.
float mean_at(vec3 place) {
  vec3 at = place / mean_width - 0.5, corner = floor(at), f = at - corner;
  float sum = 0.0, weight = 0.0;
  for (int k = 0; k < 8; ++k) {
    ivec3 bit = ivec3(k & 1, k >> 1 & 1, k >> 2);
    uint found = brick_at(ivec3(corner) + bit);
    float mean = found == nothing ? -1.0 : texelFetch(shown, values + int(found)).r;
    vec3 share = mix(1.0 - f, f, bvec3(bit));
    float w = mean < 0.0 ? 0.0 : share.x * share.y * share.z;
    sum += w * mean;
    weight += w;
  }
  return weight > 1e-3 ? sum / weight : -1.0;
}
#endif
