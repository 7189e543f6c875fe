// An image in the world, as it is: without light, and never cut, so that it can lie in the plane of a cut.
in vec2 place;
out vec4 pixel;

uniform sampler2D image;

void main() {
  pixel = texture(image, place);
  if (pixel.a < 0.5) discard;
}
