// Nacre: shader programs, from sources that are embedded in the program.
#pragma once

#include <GL/glew.h>

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace nacre {

/// One file of shaders/.
struct ShaderSource {
  std::string_view name, text;
};

/// All files; the build generates this function.
std::span<const ShaderSource> shader_sources();

/// A vertex and a fragment shader, linked. A line `#include "NAME"` is replaced by that file.
class Program {
 public:
  Program() = default;
  /// `prelude` follows #version in both: definitions, or whole functions. Throws Error with the message of the
  /// compiler.
  Program(std::string_view vertex, std::string_view fragment, std::string_view prelude = {});
  ~Program();
  Program(Program&& other) noexcept { *this = static_cast<Program&&>(other); }
  Program& operator=(Program&& other) noexcept;

  void use() const { glUseProgram(id_); }
  GLuint id() const { return id_; }

  // Sets uniforms by name. Names that the compiler has optimised away are ignored. Matrices: column by column.
  void set(const char* name, int value) const;
  void set(const char* name, float value) const;
  void set(const char* name, const std::array<int, 3>& value) const;
  void set(const char* name, const std::array<float, 2>& value) const;
  void set(const char* name, const std::array<float, 3>& value) const;
  void set(const char* name, const std::array<float, 4>& value) const;
  void set(const char* name, const std::array<float, 9>& matrix) const;
  void set(const char* name, const std::array<float, 16>& matrix) const;

 private:
  GLint location(const char* name) const { return glGetUniformLocation(id_, name); }

  GLuint id_ = 0;
};

}  // namespace nacre
