// Marks of one size in pixels, 4 vertices per instance.
#include "view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec4 mark;  // colour (encoded), shape

uniform float radius;  // pixels, with the outline
uniform float lift;    // towards the eye, so that a mark is not hidden by the triangles that it lies on

out vec3 seen;
out vec2 corner;  // 1: at the edge of the outline
flat out vec4 kind;

void main() {
  corner = (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0) * 1.5;  // a diamond reaches farther than a disc
  kind = mark;
  gl_Position = clip_from_model * vec4(position, 1.0);
  gl_Position.xy += 2.0 * corner * radius / picture_size * gl_Position.w;
  gl_Position.z += lift * (ray_direction.w > 0.5 ? 1.0 : gl_Position.z);
  seen = (seen_from_model * vec4(position, 1.0)).xyz;
}
