// A surface with the texture of the flow and a colour map, with the appearance of compute/raycast/render.hpp.
#include "view.glsl"

in vec3 seen;
in vec3 direction;
in vec3 place;
in float shade;
out vec4 pixel;

uniform bool coloured;
uniform vec2 range;  // of the colour map
uniform sampler1D colours;

#if defined(OCTREE)
#include "octree_texture.glsl"
#elif defined(TEXTURED)
#include "sparse_texture.glsl"
#endif

void main() {
  if (is_cut(seen)) discard;
  vec3 base = vec3(0.62);
  if (coloured) {
    float x = (shade - range.x) / (range.y - range.x);
    x = x > 0.0 ? min(x, 1.0) : 0.0;  // NaN is at the lower end
    base = texture(colours, (x * 255.0 + 0.5) / 256.0).rgb;
  }
  float light_here = brightness(direction, seen);
#ifdef TEXTURED
  light_here *= 0.04 + 1.52 * shown_at(place);
#endif
  pixel = vec4(to_encoded(base * light_here), 1.0);
}
