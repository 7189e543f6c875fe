// A parallelogram: the unit square in its own coordinates.
#include "view.glsl"

out vec2 place;

void main() {
  place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = clip_from_model * vec4(place, 0.0, 1.0);
}
