// Camera and light for all passes; set by set_view (engine/render/view.hpp).
uniform mat4 clip_from_model;
uniform mat4 seen_from_model;    // axes and lengths of the world, relative to the eye
uniform mat4 clip_from_seen;
uniform mat3 normal_from_model;  // gives directions only: to be normalised
uniform vec4 ray_direction;      // w = 1: the same for all pixels (orthographic)
uniform vec3 light;
uniform float ambient;
uniform vec2 picture_size;
uniform vec4 clip_planes[7];  // each keeps dot(xyz, seen) + w >= 0
uniform int clip_count;

vec3 to_linear(vec3 c) { return c * c; }  // gamma 2, near sRGB
vec3 to_encoded(vec3 c) { return sqrt(clamp(c, 0.0, 1.0)); }

vec3 ray_to(vec3 seen) { return ray_direction.w > 0.5 ? ray_direction.xyz : seen; }

// How much light a point with this normal reflects to the eye; surfaces have two sides.
float brightness(vec3 normal, vec3 seen) {
  vec3 n = normalize(normal);
  float facing = dot(n, ray_to(seen)) > 0.0 ? -1.0 : 1.0;
  return ambient + (1.0 - ambient) * max(dot(n, light) * facing, 0.0);
}

bool is_cut(vec3 seen) {
  for (int k = 0; k < clip_count; ++k)
    if (dot(clip_planes[k].xyz, seen) + clip_planes[k].w < 0.0) return true;
  return false;
}
