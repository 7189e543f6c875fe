// Nacre: shader programs.
#include "engine/gl/shader.hpp"

#include <cassert>
#include <utility>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

std::string_view source_named(std::string_view name) {
  for (const ShaderSource& source : shader_sources())
    if (source.name == name) return source.text;
  throw Error("no shader named " + std::string(name));
}

/// The text of a file with its includes inserted.
std::string with_includes(std::string_view name) {
  constexpr std::string_view word = "#include \"";
  std::string_view rest = source_named(name);
  std::string text;
  for (std::size_t at = rest.find(word); at != rest.npos; at = rest.find(word)) {
    const std::size_t end = rest.find('"', at + word.size());
    text += rest.substr(0, at);
    text += with_includes(rest.substr(at + word.size(), end - at - word.size()));
    rest.remove_prefix(end + 1);
  }
  return text.append(rest);
}

/// The messages of the compiler or linker.
template <class Length, class Text>
std::string log_of(GLuint id, const Length& length_of, const Text& text_of) {
  GLint length = 0;
  length_of(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(std::size_t(length > 0 ? length : 0), '\0');
  if (length > 0) text_of(id, length, nullptr, log.data());
  return log;
}

GLuint compile(GLenum stage, std::string_view name, std::string_view prelude) {
  const std::string text = "#version 450 core\n" + std::string(prelude) + "\n#line 1\n" + with_includes(name);
  const char* start = text.c_str();
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &start, nullptr);
  glCompileShader(shader);
  GLint good = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  const std::string log = log_of(shader, glGetShaderiv, glGetShaderInfoLog);
  glDeleteShader(shader);
  throw Error("shader " + std::string(name) + " does not compile", log, "report this with the name of your driver");
}

}  // namespace

Program::Program(std::string_view vertex, std::string_view fragment, std::string_view prelude) {
  const GLuint first = compile(GL_VERTEX_SHADER, vertex, prelude);
  GLuint second = 0;
  try {
    second = compile(GL_FRAGMENT_SHADER, fragment, prelude);
  } catch (...) {
    glDeleteShader(first);
    throw;
  }
  id_ = glCreateProgram();
  glAttachShader(id_, first);
  glAttachShader(id_, second);
  glLinkProgram(id_);
  glDeleteShader(first);
  glDeleteShader(second);
  GLint good = GL_FALSE;
  glGetProgramiv(id_, GL_LINK_STATUS, &good);
  if (good) return;
  const std::string log = log_of(id_, glGetProgramiv, glGetProgramInfoLog);
  glDeleteProgram(id_);
  throw Error("shaders " + std::string(vertex) + " and " + std::string(fragment) + " do not link", log,
              "report this with the name of your driver");
}

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

void Program::set(const char* name, int value) const { glProgramUniform1i(id_, location(name), value); }
void Program::set(const char* name, float value) const { glProgramUniform1f(id_, location(name), value); }
void Program::set(const char* name, const std::array<int, 3>& v) const {
  glProgramUniform3iv(id_, location(name), 1, v.data());
}
void Program::set(const char* name, const std::array<float, 2>& v) const {
  glProgramUniform2fv(id_, location(name), 1, v.data());
}
void Program::set(const char* name, const std::array<float, 3>& v) const {
  glProgramUniform3fv(id_, location(name), 1, v.data());
}
void Program::set(const char* name, const std::array<float, 4>& v) const {
  glProgramUniform4fv(id_, location(name), 1, v.data());
}
void Program::set(const char* name, const std::array<float, 9>& m) const {
  glProgramUniformMatrix3fv(id_, location(name), 1, GL_FALSE, m.data());
}
void Program::set(const char* name, const std::array<float, 16>& m) const {
  glProgramUniformMatrix4fv(id_, location(name), 1, GL_FALSE, m.data());
}

}  // namespace nacre
