// Nacre: blending over what was drawn before.
#pragma once

#include <GL/glew.h>

namespace nacre {

/// Blends by opacity while it lives. `blends`: false does nothing.
class Blended {
 public:
  explicit Blended(bool blends = true) : blends_(blends) {
    if (!blends_) return;
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }
  ~Blended() {
    if (blends_) glDisable(GL_BLEND);
  }
  Blended(const Blended&) = delete;
  Blended& operator=(const Blended&) = delete;

 private:
  bool blends_;
};

}  // namespace nacre
