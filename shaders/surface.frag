// A surface with the texture of the flow and a colour map, with the appearance of compute/raycast/render.hpp.
#include "view.glsl"

in vec3 seen;
in vec3 direction;
in vec3 place;
in float shade;
out vec4 pixel;

uniform bool coloured;
uniform vec2 range;  // of the colour map
uniform float isolines;  // steps of the range between lines of equal value; 0: no lines
uniform vec3 below;  // of values beyond it
uniform vec3 above;
uniform vec3 no_number;
uniform sampler1D colours;
uniform bool neutral;  // these faces are grey
uniform float opacity;

#if defined(OCTREE)
#include "octree_texture.glsl"
#include "footprint.glsl"
#elif defined(TEXTURED)
#include "sparse_texture.glsl"
#include "footprint.glsl"
#endif

void main() {
  if (is_cut(seen)) discard;
  vec3 base = vec3(0.62);
  if (coloured && !neutral) {
    float x = (shade - range.x) / (range.y - range.x);
    float pixel_step = max(fwidth(x) * isolines, 1e-6);
    if (!(x >= 0.0) && !(x < 0.0))
      base = no_number;
    else if (x < -1e-5)
      base = below;
    else if (x > 1.0 + 1e-5)
      base = above;
    else
      base = texture(colours, (clamp(x, 0.0, 1.0) * 255.0 + 0.5) / 256.0).rgb;
    if (isolines > 0.0 && x > 0.0 && x < 1.0) {
      float nearest = abs(fract(x * isolines + 0.5) - 0.5) / pixel_step;  // pixels to the next line
      base *= mix(0.06, 1.0, smoothstep(0.5, 1.5, nearest));
    }
  }
  float light_here = brightness(direction, seen);
#ifdef TEXTURED
  if (!neutral) light_here *= 0.04 + 1.52 * shown_at(place);
#endif
  pixel = vec4(to_encoded(base * light_here), opacity);
}
