// Nacre: a scene of the viewer without a window, for its tests.
#pragma once

#include <functional>
#include <memory>

#include "app/viewer/scene/changed_knobs.hpp"
#include "engine/scene/session/session.hpp"
#include "tests/engine/gl/offscreen.hpp"

namespace nacre::test {

template <class AnyScene>
class SceneInView : public Offscreen {
 protected:
  void TearDown() override {
    scene_.reset();  // before the context
    Offscreen::TearDown();
  }

  /// As a user changes knobs.
  void change(const std::function<void(Settings&)>& how) {
    const Session before = session_;
    how(session_.settings);
    scene_->set_settings(session_.settings, changed_knobs(before, session_));
  }

  Session session_;
  std::unique_ptr<AnyScene> scene_;
};

}  // namespace nacre::test
