// Solid arrows, one per instance: a shaft of six sides and a pointed head.
#include "view.glsl"

layout(location = 0) in vec3 tail;
layout(location = 1) in vec3 arrow;   // in the world
layout(location = 2) in vec3 normal;  // of the surface
layout(location = 3) in float value;

uniform float scale;
uniform float width;  // of the head

out vec3 seen;
out vec3 direction;
out float shade;

const int sides = 6;
const float turn = 6.2831853 / float(sides);

void main() {
  vec3 way = arrow * scale;
  float size = length(way), radius = min(0.5 * width, 0.17 * size), shaft = 0.36 * radius, neck = size - 2.4 * radius;
  vec3 ahead = size > 0.0 ? way / size : vec3(0.0);
  vec3 across = cross(ahead, normal);
  across = dot(across, across) > 1e-12 ? normalize(across) : vec3(0.0);
  vec3 up = cross(across, ahead);
  // One side: the quad of the shaft as two triangles, then the triangle of the head.
  int side = gl_VertexID / 9, corner = gl_VertexID % 9;
  bool head = corner >= 6;
  int step = head ? int(corner == 7) : int(corner == 1 || corner == 3 || corner == 4);
  bool far = head ? corner == 8 : corner == 2 || corner == 4 || corner == 5;
  float angle = turn * (float(side + step) + (head && far ? 0.5 : 0.0));
  vec3 out_from_axis = across * cos(angle) + up * sin(angle);
  vec3 place = head ? (far ? ahead * size : ahead * neck + out_from_axis * radius)
                    : (far ? ahead * neck : vec3(0.0)) + out_from_axis * shaft;
  direction = head ? out_from_axis * (size - neck) + ahead * radius : out_from_axis;
  vec3 from = (seen_from_model * vec4(tail, 1.0)).xyz + normal * shaft;
  seen = from + place;
  gl_Position = clip_from_seen * vec4(seen, 1.0);
  shade = value;
}
