// Nacre: the context, and what is made in it.
#include <GL/glew.h>

#include <array>
#include <cstring>
#include <vector>

#include "engine/gl/buffer.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/gl/shader.hpp"
#include "engine/gl/texture.hpp"
#include "tests/engine/gl/offscreen.hpp"

namespace nacre {
namespace {

using Gl = test::Offscreen;

std::array<int, 4> pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = image.at(x, y);
  return {p[0], p[1], p[2], p[3]};
}

TEST_F(Gl, ContextIsOfTheVersionAskedFor) {
  GLint major = 0, minor = 0, profile = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  EXPECT_GE(major * 10 + minor, 45);
  EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
  EXPECT_FALSE(context().renderer().empty());
}

TEST_F(Gl, TwoContextsLiveSideBySide) {
  const auto second = make_offscreen_context();
  const Buffer there(16);
  EXPECT_TRUE(glIsBuffer(there.id()));
  context().make_current();
  Buffer here(16);
  EXPECT_TRUE(glIsBuffer(here.id()));
  second->make_current();
  EXPECT_TRUE(second->messages().empty());
  context().make_current();
}

TEST(GlMessages, AWrongCallIsCollected) {
  std::unique_ptr<Context> context;
  try {
    context = make_offscreen_context();
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  glEnable(GL_POINTS);  // not a capability
  glFinish();
  EXPECT_EQ(glGetError(), GLenum(GL_INVALID_ENUM));
  EXPECT_EQ(context->messages().size(), 1u);
}

TEST(GlMessages, TooLargeABufferIsAnErrorAndBreaksNothing) {
  std::unique_ptr<Context> context;
  try {
    context = make_offscreen_context();
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  EXPECT_THROW(Buffer(std::size_t(1) << 46), Error);
  EXPECT_TRUE(Buffer(64));
}

TEST_F(Gl, BufferHoldsWhatItWasGiven) {
  const std::vector<int> numbers{3, 1, 4, 1, 5};
  Buffer buffer = Buffer::of<int>(numbers);
  EXPECT_EQ(buffer.bytes(), 20u);
  std::vector<int> back(5);
  glGetNamedBufferSubData(buffer.id(), 0, 20, back.data());
  EXPECT_EQ(back, numbers);
  const GLuint id = buffer.id();
  const Buffer moved = std::move(buffer);
  EXPECT_EQ(moved.id(), id);
  EXPECT_FALSE(Buffer(0));
}

TEST_F(Gl, MappedMemoryIsTheBuffers) {
  constexpr GLbitfield flags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  Buffer buffer(8, flags);
  const std::array<float, 2> written{1.5f, -2};
  std::memcpy(buffer.map(flags), written.data(), 8);
  std::array<float, 2> read{};
  glGetNamedBufferSubData(buffer.id(), 0, 8, read.data());
  EXPECT_EQ(read, written);
}

TEST_F(Gl, PictureHasItsFirstRowAtTheTop) {
  const Framebuffer frame(8, 6);
  frame.bind();
  frame.clear({0, 0, 1, 1});
  const Program program("fill.vert", "fill.frag");
  program.use();
  program.set("colour", std::array<float, 4>{1, 0, 0, 0.5f});
  GLuint nothing = 0;
  glCreateVertexArrays(1, &nothing);
  glBindVertexArray(nothing);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 4, 3, 2);  // OpenGL counts rows from the bottom
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
  glDeleteVertexArrays(1, &nothing);
  const Image image = frame.read();
  EXPECT_EQ(pixel(image, 0, 0), (std::array<int, 4>{255, 0, 0, 128}));
  EXPECT_EQ(pixel(image, 2, 1), (std::array<int, 4>{255, 0, 0, 128}));
  EXPECT_EQ(pixel(image, 3, 1), (std::array<int, 4>{0, 0, 255, 255}));
  EXPECT_EQ(pixel(image, 0, 2), (std::array<int, 4>{0, 0, 255, 255}));
}

TEST_F(Gl, SamplesAreResolved) {
  const Framebuffer frame(16, 16, 4);
  if (frame.samples() < 2) GTEST_SKIP() << "no multisampling here";
  frame.bind();
  frame.clear({0, 1, 0, 1});
  const Image image = frame.read();
  EXPECT_EQ(pixel(image, 15, 15), (std::array<int, 4>{0, 255, 0, 255}));
}

TEST_F(Gl, PictureSizesAreChecked) {
  EXPECT_THROW(Framebuffer(0, 10), Error);
  EXPECT_THROW(Framebuffer(10, -1), Error);
  EXPECT_THROW(Framebuffer(Framebuffer::most_size() + 1, 1), Error);
}

TEST_F(Gl, ShaderErrorsAreTold) {
  EXPECT_THROW(Program("no.vert", "fill.frag"), Error);
  try {
    Program("fill.vert", "fill.frag", "#error on purpose");
    FAIL() << "compiled";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("on purpose"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace nacre
