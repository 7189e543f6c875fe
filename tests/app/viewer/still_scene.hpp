// Nacre: a scene in which nothing happens.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/viewer/scene/scene.hpp"

namespace nacre::test {

/// Corners, and what a test says of its state.
class StillScene : public Scene {
 public:
  std::vector<Vec3d> points;
  std::uint64_t seen_changes = 1;
  bool legend = false;
  std::string what_failed;
  SceneProgress doing;
  std::string name = "scene";

  StillScene(const Vec3d& low, const Vec3d& high) { set(low, high); }
  void set(const Vec3d& low, const Vec3d& high) {
    points.clear();
    for (int k = 0; k < 8; ++k)
      points.push_back({k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
    ++seen_changes;
  }

  const std::vector<Vec3d>& corners() const override { return points; }
  std::uint64_t seen_version() const override { return seen_changes; }
  bool has_legend() const override { return legend; }

  void advance(double) override {}
  bool advance_and_wait(const std::atomic<bool>&, double) override { return true; }
  void set_settings(const Settings&, const ChangedKnobs&) override {}
  int cancels = 0, resumes = 0;
  bool flow = false;
  bool is_flow() const override { return flow; }
  void cancel() override { ++cancels; }
  void resume() override { ++resumes; }
  bool halted() const override { return false; }
  void draw(const View&) override {}
  Image overlay(int, int) override { return {}; }
  std::uint64_t overlay_version() const override { return 0; }
  std::uint64_t version() const override { return 0; }
  std::optional<Vec3d> under_the_mouse;  ///< wherever that is
  std::optional<ProbeResult> probe(const Vec3d&, const Vec3d&) override {
    return under_the_mouse ? std::optional(ProbeResult{*under_the_mouse, {}}) : std::nullopt;
  }
  void write_result(const std::filesystem::path&, const std::string&) override {}
  void begin_write(const std::filesystem::path&, const std::string&) override {}
  std::optional<std::string> take_written() override { return {}; }
  std::vector<std::string> result_formats() const override { return {}; }
  bool complete() const override { return true; }
  bool settled() const override { return true; }
  std::string title() const override { return name; }
  std::string state() const override { return ""; }
  SceneProgress progress() const override { return doing; }
  const std::string& failure() const override { return what_failed; }
  const std::vector<std::string>& warnings() const override { return none_; }
  std::string remark() const override { return ""; }
  std::size_t bytes = 0;
  SceneTotals totals() const override { return {0, 0, {}, bytes}; }
  const Device& device() const override { return *device_; }
  void finish() override {}

 private:
  std::vector<std::string> none_;
  std::unique_ptr<Device> device_ = make_cpu_device();
};

}  // namespace nacre::test
