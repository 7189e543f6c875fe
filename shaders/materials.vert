#include "view.glsl"

layout(location = 0) in vec3 position;

out vec3 seen;

void main() {
  gl_Position = clip_from_model * vec4(position, 1.0);
  seen = (seen_from_model * vec4(position, 1.0)).xyz;
}
