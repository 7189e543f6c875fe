#include "view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint point;  // of the mesh: several vertices share one at a crease
layout(location = 3) in float sheet;    // 1 in a second sheet
layout(location = 4) in vec3 embedded;  // the position where the texture is, of a surface that has moved

uniform samplerBuffer scalar;  // per point
uniform bool coloured;
uniform samplerBuffer dye;  // per point: concentrations
uniform bool dyed;
uniform vec4 texture_from_model;  // offset, scale
uniform vec3 sheet_shift;         // to the cells of a second sheet

out vec3 seen;
out vec3 direction;  // of the normal
out vec3 place;      // in texture cells
out float shade;     // of the colour map
out vec4 dyes;

void main() {
  gl_Position = clip_from_model * vec4(position, 1.0);
  seen = (seen_from_model * vec4(position, 1.0)).xyz;
  direction = normal_from_model * normal;
  place = embedded * texture_from_model.w + texture_from_model.xyz + sheet * sheet_shift;
  dyes = dyed ? texelFetch(dye, int(point)) : vec4(0.0);
  shade = coloured ? texelFetch(scalar, int(point)).r : 0.0;
}
