// An image in the world, without light, and never clipped, so that it can lie in the clip plane.
in vec2 place;
out vec4 pixel;

uniform sampler2D image;

void main() {
  pixel = texture(image, place);
  if (pixel.a < 0.5) discard;
}
