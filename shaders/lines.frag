// Lines of one colour, clipped like the surface.
#include "view.glsl"

in vec3 seen;
out vec4 pixel;

uniform vec4 colour;  // encoded

void main() {
  if (is_cut(seen)) discard;
  pixel = colour;
}
