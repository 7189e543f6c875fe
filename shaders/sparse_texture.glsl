// The shown value at a position of the surface, from the sparse grid: brick, block, texel, value (RefinedGridView,
// compute/embedding/refined_grid.hpp). SUB, REFINE, fetch_brick, fetch_block and fetch_texel are in the prelude. Here a
// block also has the first texels of its neighbours (with_rims, engine/render/sparse_texture.hpp).
uniform samplerBuffer shown;  // a value per surface cell, then a mean per block
uniform int values;           // how many surface cells there are; -1: no means follow
uniform ivec3 bricks;

const uint nothing = 0xffffffffu;

uint block_of(ivec3 cell) {
  ivec3 brick = cell / SUB;
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(brick, bricks))) return nothing;
  uint b = fetch_brick(uint((brick.z * bricks.y + brick.y) * bricks.x + brick.x));
  if (b == nothing) return nothing;
  ivec3 rest = cell - brick * SUB;
  return fetch_block(b * uint(SUB * SUB * SUB) + uint((rest.z * SUB + rest.y) * SUB + rest.x));
}

// Linear among the texture cells around `place` (in texture cells) that have a value; -1 if there is none.
float fine_at(vec3 place) {
  const int side = REFINE + 1;
  vec3 corner = floor(place - 0.5);
  vec3 f = place - 0.5 - corner;
  ivec3 first = ivec3(corner), cell = first / REFINE, rest = first - cell * REFINE;
  uint block = block_of(cell);
  if (block == nothing) return -1.0;
  uint base = block * uint(side * side * side) + uint((rest.z * side + rest.y) * side + rest.x);
  float sum = 0.0, weight = 0.0;
  for (int k = 0; k < 8; ++k) {
    ivec3 bit = ivec3(k & 1, k >> 1 & 1, k >> 2);
    uint texel = fetch_texel(base + uint((bit.z * side + bit.y) * side + bit.x));
    vec3 share = mix(1.0 - f, f, bvec3(bit));
    float w = texel == nothing ? 0.0 : share.x * share.y * share.z;
    sum += w * texelFetch(shown, texel == nothing ? 0 : int(texel)).r;
    weight += w;
  }
  return weight > 0.0 ? sum / weight : -1.0;
}

const float mean_width = float(REFINE);  // texture cells

// The same among the means of blocks.
float mean_at(vec3 place) {
  vec3 at = place / mean_width - 0.5, corner = floor(at), f = at - corner;
  float sum = 0.0, weight = 0.0;
  for (int k = 0; k < 8; ++k) {
    ivec3 bit = ivec3(k & 1, k >> 1 & 1, k >> 2);
    uint block = block_of(ivec3(corner) + bit);
    float mean = block == nothing ? -1.0 : texelFetch(shown, values + int(block)).r;
    vec3 share = mix(1.0 - f, f, bvec3(bit));
    float w = mean < 0.0 ? 0.0 : share.x * share.y * share.z;
    sum += w * mean;
    weight += w;
  }
  return weight > 1e-3 ? sum / weight : -1.0;
}
