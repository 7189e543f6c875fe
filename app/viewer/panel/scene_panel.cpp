// Nacre: which scene and panel an input gets.
#include "app/viewer/panel/scene_panel.hpp"

#include <utility>

#include "app/viewer/flow/flow_scene.hpp"
#include "app/viewer/mesh/mesh_scene.hpp"
#include "app/viewer/panel/flow_panel.hpp"
#include "app/viewer/panel/mesh_panel.hpp"

namespace nacre {

OpenScene open_scene(const Session& session, const SceneOptions& options) {
  if (is_mesh_input(session)) {
    auto scene = std::make_unique<MeshScene>(session, options);
    auto panel = std::make_unique<MeshPanel>(scene->results());
    return {std::move(scene), std::move(panel)};
  }
  auto scene = std::make_unique<FlowScene>(session, options.open_device(), options.loop, options.low_priority);
  scene->set_lockstep(options.lockstep);
  scene->set_stop(options.stop);
  auto panel = std::make_unique<FlowPanel>(scene->results());
  return {std::move(scene), std::move(panel)};
}

}  // namespace nacre
