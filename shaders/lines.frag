// Lines of one colour, cut where the surface is.
#include "view.glsl"

in vec3 seen;
out vec4 pixel;

uniform vec4 colour;  // encoded

void main() {
  if (is_cut(seen)) discard;
  pixel = colour;
}
