// Tiles of an image at the lower right corner of the picture.
layout(location = 0) in vec2 tile;  // upper left corner, in pixels of the image

uniform vec2 image_size;
uniform vec2 picture_size;
uniform float edge;  // of a tile

out vec2 place;  // in pixels of the image

void main() {
  place = min(tile + edge * vec2(gl_VertexID & 1, gl_VertexID >> 1), image_size);
  vec2 pixel = vec2(picture_size.x - image_size.x + place.x, image_size.y - place.y);
  gl_Position = vec4(pixel / picture_size * 2.0 - 1.0, 1.0, 1.0);
}
