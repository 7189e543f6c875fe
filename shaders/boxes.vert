// Boxes as lines, 24 vertices per instance, directly from what a build has written: corners, or Morton codes of cubes.
#include "view.glsl"

#ifdef MORTON
layout(location = 0) in uvec2 code;  // low and high half; bits x, y, z from the lowest
uniform float width;                 // of a cube, in the model's units

// Gathers bits 0, 3, .. 27.
uint ten_bits(uint bits) {
  bits &= 0x09249249u;
  bits = (bits | bits >> 2) & 0x030c30c3u;
  bits = (bits | bits >> 4) & 0x0300f00fu;
  bits = (bits | bits >> 8) & 0x030000ffu;
  return (bits | bits >> 16) & 0x3ffu;
}

uint every_third_bit(uvec2 bits, int axis) {
  uint middle = bits.x >> 30 | bits.y << 2;
  return ten_bits(bits.x >> axis) | ten_bits(middle >> axis) << 10 | (bits.y >> (28 + axis) & 1u) << 20;
}
#else
layout(location = 0) in vec3 low;
layout(location = 1) in vec3 high;
#endif

out vec3 seen;

void main() {
#ifdef MORTON
  vec3 low = vec3(every_third_bit(code, 0), every_third_bit(code, 1), every_third_bit(code, 2)) * width;
  vec3 high = low + width;
#endif
  int edge = gl_VertexID / 2, axis = edge / 4;  // 4 edges along each axis
  ivec3 side = ivec3(0);
  side[axis] = gl_VertexID & 1;
  side[(axis + 1) % 3] = edge & 1;
  side[(axis + 2) % 3] = edge >> 1 & 1;
  vec3 position = mix(low, high, vec3(side));
  gl_Position = clip_from_model * vec4(position, 1.0);
  seen = (seen_from_model * vec4(position, 1.0)).xyz;
}
