// Discs, 4 vertices per instance, directly from the arrays of the solver (ParticleSet).
#include "view.glsl"

layout(location = 0) in vec4 particle;  // x, y, z, h
layout(location = 1) in vec4 heading;   // unit normal or tangent, energy

uniform float size;        // radius of a disc in h
uniform bool face_camera;  // heading is not a normal
uniform bool by_energy;    // else by h
uniform vec2 range;        // of the colour map

out vec3 seen;
out vec3 direction;
out vec2 corner;
out float shade;

void main() {
  corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 centre = (seen_from_model * vec4(particle.xyz, 1.0)).xyz;
  vec3 towards = face_camera ? -normalize(ray_to(centre)) : normalize(normal_from_model * heading.xyz);
  vec3 across = normalize(abs(towards.z) < 0.9 ? vec3(-towards.y, towards.x, 0.0) : vec3(0.0, -towards.z, towards.y));
  vec3 up = cross(towards, across);
  // One scale for all axes, so that a disc is round even if voxels are not cubes.
  float unit = length(seen_from_model[0].xyz) * particle.w * size;
  seen = centre + (across * corner.x + up * corner.y) * unit;
  gl_Position = clip_from_seen * vec4(seen, 1.0);
  direction = towards;
  float value = by_energy ? heading.w : particle.w;
  float x = (value - range.x) / (range.y - range.x);
  shade = x > 0.0 ? min(x, 1.0) : 0.0;
}
