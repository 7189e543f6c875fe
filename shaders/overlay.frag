// An image over the picture, from its lower border up; row 0 of the image is its highest.
uniform sampler2D image;
uniform int left;
out vec4 pixel;

void main() {
  ivec2 place = ivec2(gl_FragCoord.xy);
  pixel = texelFetch(image, ivec2(place.x - left, textureSize(image, 0).y - 1 - place.y), 0);
}
