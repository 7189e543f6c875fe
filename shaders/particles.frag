#include "view.glsl"

in vec3 seen;
in vec3 direction;
in vec2 corner;
in float shade;
out vec4 pixel;

uniform sampler1D colours;

void main() {
  float r2 = dot(corner, corner);
  if (r2 > 1.0 || is_cut(seen)) discard;
  vec3 base = texture(colours, (shade * 255.0 + 0.5) / 256.0).rgb;
  float rim = r2 > 0.7 ? 0.55 : 1.0;  // a darker rim separates neighbours that overlap
  pixel = vec4(to_encoded(base * brightness(direction, seen) * rim), 1.0);
}
