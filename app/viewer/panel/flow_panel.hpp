// Nacre: a flow in the panel: its data, its embedding and pace, vectors, time, colours.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/viewer/flow/flow_results.hpp"
#include "app/viewer/panel/scene_panel.hpp"

namespace nacre {

/// What the data offer for the knobs `vectors` and `color`; for another knob: empty, anything may be written.
std::vector<std::string> flow_choices(const FlowOffer& offer, const std::string& knob);

class FlowPanel : public ScenePanel {
 public:
  explicit FlowPanel(const FlowResults& results) : results_(results) {}

  void data_tab(Session& session) override;
  void look_tab(Session& session) override;
  void result_tab(Session& session) override;

 private:
  /// Two numbers, while they are typed.
  struct RangeEdit {
    std::array<double, 2> ends{};
    bool active = false;
    Range range() const { return {ends[0], ends[1]}; }
  };

  static bool edit_range(const char* label, RangeEdit& edit, const Range& now);
  void show_time(Session& session);
  void colours(Session& session);
  void show_vectors() const;
  void show_embedding() const;
  void show_probes(Session& session) const;
  void plot(const std::vector<double>& times, const std::vector<float>& values, const std::string& name) const;
  void critical_points(Session& session) const;

  const FlowResults& results_;
  RangeEdit time_edit_, colours_edit_;
};

}  // namespace nacre
