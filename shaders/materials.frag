// Triangles between materials, flat, with the appearance of compute/raycast/mesh_picture.hpp. A material can be solid,
// a ghost or hidden; a triangle takes the more visible of its two materials.
#include "view.glsl"
#include "backs.glsl"

in vec3 seen;
out vec4 pixel;

uniform usamplerBuffer materials;      // per triangle: the two numbers, 16 bits each
uniform samplerBuffer material_colour;   // per material: encoded colour, opacity
uniform bool ghosts;                   // draw those, or the solid ones

void main() {
  if (is_cut(seen)) discard;
  uint pair = texelFetch(materials, gl_PrimitiveID).r;
  vec4 low = texelFetch(material_colour, int(pair & 0xffffu)), high = texelFetch(material_colour, int(pair >> 16));
  bool outside = (pair & 0xffffu) == 0u;
  float opacity = outside ? high.a : max(low.a, high.a);
  if (opacity <= 0.0 || (opacity < 1.0) != ghosts) discard;
  bool behind = outside && is_back();  // between two materials, both sides are fronts
  if (behind && backs == 2) discard;
  vec3 colour = outside ? high.rgb : mix(0.5 * (low.rgb + high.rgb), vec3(1.0), 0.35);
  vec3 normal = cross(dFdx(seen), dFdy(seen));
  vec3 base = behind ? neutral_back : to_linear(colour);
  pixel = vec4(to_encoded(base * brightness(normal, seen)), opacity);
}
