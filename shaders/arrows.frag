#include "view.glsl"

in vec3 seen;
in vec3 direction;
in float shade;
out vec4 pixel;

uniform sampler1D colours;
uniform vec3 ink;     // encoded
uniform bool mapped;  // coloured by the colour map instead

void main() {
  if (is_cut(seen)) discard;
  vec3 base = mapped ? texture(colours, (clamp(shade, 0.0, 1.0) * 255.0 + 0.5) / 256.0).rgb : ink;
  pixel = vec4(to_encoded(to_linear(base) * brightness(direction, seen)), 1.0);
}
