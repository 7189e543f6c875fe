// Nacre: an OpenGL context for tests, without a display.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "compute/device/error.hpp"
#include "engine/gl/context.hpp"

namespace nacre::test {

/// Has a context; the test is skipped, aloud, where there is none. At its end the driver must not have complained.
class Offscreen : public testing::Test {
 protected:
  void SetUp() override {
    try {
      context_ = make_offscreen_context();
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }

  void TearDown() override {
    if (!context_) return;
    for (const std::string& message : context_->messages()) ADD_FAILURE() << "the driver says: " << message;
  }

  Context& context() { return *context_; }

 private:
  std::unique_ptr<Context> context_;
};

}  // namespace nacre::test
