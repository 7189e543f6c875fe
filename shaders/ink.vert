// Flat colours at places of the picture, in pixels from the left lower corner.
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 ink;
uniform vec2 picture_size;
out vec4 colour;

void main() {
  gl_Position = vec4(position / picture_size * 2.0 - 1.0, 1.0, 1.0);
  colour = ink;
}
