// Boxes as lines, 24 vertices an instance, straight from what a build has written: corners, or Morton codes of cubes.
#include "view.glsl"

#ifdef MORTON
layout(location = 0) in uvec2 code;  // low and high half; bits x, y, z from the lowest
uniform float width;                 // of a cube, in the model's units

uint every_third_bit(uvec2 bits, uint axis) {
  uint found = 0u;
  for (uint k = 0u; k < 21u; ++k) {
    uint at = 3u * k + axis;
    found |= ((at < 32u ? bits.x >> at : bits.y >> (at - 32u)) & 1u) << k;
  }
  return found;
}
#else
layout(location = 0) in vec3 low;
layout(location = 1) in vec3 high;
#endif

out vec3 seen;

void main() {
#ifdef MORTON
  vec3 low = vec3(every_third_bit(code, 0u), every_third_bit(code, 1u), every_third_bit(code, 2u)) * width;
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
