// Discs, rings and diamonds with a dark outline.
#include "view.glsl"

in vec3 seen;
in vec2 corner;
flat in vec4 kind;
out vec4 pixel;

uniform float radius;
uniform vec3 outline;  // encoded

void main() {
  if (is_cut(seen)) discard;
  bool diamond = kind.a > 1.5, ring = kind.a > 0.5 && !diamond;
  float disc = length(corner);
  // Distance from the middle: 1 at the edge of the outline, 1 / 1.3 at that of the mark.
  float r = diamond ? (abs(corner.x) + abs(corner.y)) / 1.4 : disc;
  float cover = clamp((1.0 - r) * radius + 0.5, 0.0, 1.0);
  if (cover == 0.0) discard;
  float inside = clamp((1.0 / 1.3 - r) * radius + 0.5, 0.0, 1.0);
  float hole = ring ? clamp((0.4 / 1.3 - disc) * radius + 0.5, 0.0, 1.0) : 0.0;
  pixel = vec4(mix(mix(outline, kind.rgb, inside), vec3(1.0), hole), cover);
}
