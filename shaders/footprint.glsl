// The shown value over a pixel: as compute/raycast/footprint.hpp. `fine_at` looks one value up, `mean_at` the mean over
// cubes `mean_width` texture cells wide (0: there are none); both give -1 where there is nothing.

int taps(float size) { return clamp(int(ceil(size - 0.25)), 1, 8); }

float shown_at(vec3 place) {
  vec3 across = dFdx(place), up = dFdy(place);
  float a = length(across), b = length(up), narrow = min(a, b);
  float blend = 0.0;
  if (values >= 0 && mean_width > 1.0) blend = clamp((narrow - 0.5 * mean_width) / (0.25 * mean_width), 0.0, 1.0);
  float value = 0.0;
  for (int level = 0; level < 2; ++level) {
    float share = level == 0 ? 1.0 - blend : blend, width = level == 0 ? 1.0 : mean_width;
    if (share == 0.0) continue;
    int nx = taps(a / width), ny = taps(b / width), count = 0;
    float sum = 0.0;
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        vec2 part = vec2((float(i) + 0.5) / float(nx), (float(j) + 0.5) / float(ny)) - 0.5;
        vec3 at = place + across * part.x + up * part.y;
        float found = level == 0 ? fine_at(at) : mean_at(at);
        if (found < 0.0) continue;
        sum += found;
        ++count;
      }
    value += share * (count > 0 ? sum / float(count) : 0.5);
  }
  return value;
}
