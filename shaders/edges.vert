#include "view.glsl"

layout(location = 0) in vec3 position;

uniform float lift;  // towards the eye, so that a line is not hidden by the triangles beside it

out vec3 seen;

void main() {
  gl_Position = clip_from_model * vec4(position, 1.0);
  gl_Position.z += lift * (ray_direction.w > 0.5 ? 1.0 : gl_Position.z);
  seen = (seen_from_model * vec4(position, 1.0)).xyz;
}
