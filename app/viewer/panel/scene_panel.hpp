// Nacre: the job's own parts of the panel, drawn with Dear ImGui from what a scene knows.
#pragma once

#include <memory>

#include "app/viewer/scene/scene.hpp"

namespace nacre {

/// All may change the session: knobs, the camera.
class ScenePanel {
 public:
  virtual ~ScenePanel() = default;

  virtual void data_tab(Session& session) = 0;    ///< knobs that say what of the data is used; what the data are
  virtual void look_tab(Session& session) = 0;    ///< knobs of what is drawn
  virtual void result_tab(Session& session) = 0;  ///< figures, plots, lists
};

/// A scene, and the panel that reads its results and goes before it.
struct OpenScene {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<ScenePanel> panel;

  void reset() { panel.reset(), scene.reset(); }
};

/// For the session's input: a flow or a mesh.
OpenScene open_scene(const Session& session, const SceneOptions& options);

}  // namespace nacre
