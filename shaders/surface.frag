// A surface with the texture of the flow and a colour map, with the appearance of compute/raycast/render.hpp.
#include "view.glsl"

in vec3 seen;
in vec3 direction;
in vec3 place;
in float shade;
in vec4 dyes;
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
uniform bool dyed;
uniform vec3 inks[4];       // encoded
uniform vec4 dye_strength;  // cover, least light, full light, least concentration

#if defined(OCTREE)
#include "octree_texture.glsl"
#include "footprint.glsl"
#elif defined(TEXTURED)
#include "sparse_texture.glsl"
#include "footprint.glsl"
#endif

// As engine/run/dye_run.cpp blends them, on encoded colours.
vec3 with_dyes(vec3 colour) {
  vec4 mix_of = clamp(dyes, 0.0, 1.0);
  float sum = dot(mix_of, vec4(1.0));
  if (!(sum > dye_strength.w)) return colour;
  float light = dot(colour, vec3(0.3, 0.6, 0.1)) / dye_strength.z;
  vec3 ink = (inks[0] * mix_of.x + inks[1] * mix_of.y + inks[2] * mix_of.z + inks[3] * mix_of.w) / sum;
  ink *= mix(dye_strength.y, 1.0, min(light, 1.0));
  return mix(colour, ink, dye_strength.x * sqrt(min(sum, 1.0)));
}

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
  vec3 colour = to_encoded(base * light_here);
  if (dyed && !neutral) colour = with_dyes(colour);
  pixel = vec4(colour, opacity);
}
