// Line segments with a width in pixels, 4 vertices per instance.
#include "view.glsl"

layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;

uniform float width;  // pixels
uniform float lift;   // towards the eye, so that a line is not hidden by the triangles beside it

out vec3 seen;

void main() {
  vec4 a = clip_from_model * vec4(from, 1.0), b = clip_from_model * vec4(to, 1.0);
  // What is behind the eye is cut off: its position on the screen would be on the wrong side.
  float near = 1e-3 * max(abs(a.w), abs(b.w));
  float cut_a = a.w < near && b.w > near ? (near - a.w) / (b.w - a.w) : 0.0;
  float cut_b = b.w < near && a.w > near ? (near - b.w) / (a.w - b.w) : 0.0;
  vec4 begin = mix(a, b, cut_a), end = mix(b, a, cut_b);
  vec2 along = (end.xy / end.w - begin.xy / begin.w) * picture_size;
  along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  bool far_end = (gl_VertexID & 1) != 0;
  gl_Position = far_end ? end : begin;
  vec2 corner = across * (gl_VertexID < 2 ? -1.0 : 1.0) + along * (far_end ? 0.5 : -0.5);
  gl_Position.xy += corner * width / picture_size * gl_Position.w;
  gl_Position.z += lift * (ray_direction.w > 0.5 ? 1.0 : gl_Position.z);
  seen = (seen_from_model * vec4(far_end ? mix(to, from, cut_b) : mix(from, to, cut_a), 1.0)).xyz;
}
