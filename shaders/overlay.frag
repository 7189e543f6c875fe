// An image over the picture, pixel by pixel; row 0 of the image is at the top.
uniform sampler2D image;
in vec2 place;
out vec4 pixel;

void main() { pixel = texelFetch(image, ivec2(place), 0); }
