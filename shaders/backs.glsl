// Sides of a surface that are seen from behind.
uniform int backs;  // 0: as the front, 1: neutral, 2: not at all

const vec3 neutral_back = vec3(0.16);  // linear

bool is_back() { return backs != 0 && !gl_FrontFacing; }
