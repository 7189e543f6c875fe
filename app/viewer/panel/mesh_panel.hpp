// Nacre: a mesh in the panel: what the volume is; figures, history, materials, worst triangles.
#pragma once

#include "app/viewer/mesh/mesh_results.hpp"
#include "app/viewer/panel/material_list.hpp"
#include "app/viewer/panel/scene_panel.hpp"

namespace nacre {

class MeshPanel : public ScenePanel {
 public:
  explicit MeshPanel(const MeshResults& results) : results_(results) {}

  void data_tab(Session& session) override;
  void look_tab(Session& session) override;
  void result_tab(Session& session) override;

 private:
  const MeshResults& results_;
  MaterialList materials_;
};

}  // namespace nacre
