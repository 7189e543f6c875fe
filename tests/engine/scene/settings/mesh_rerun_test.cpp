// Nacre: where each knob of the mesh begins, for all that the table has.
#include "compute/pipeline/mesh_rerun.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>

#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

/// Knobs of MeshParameters by name, for the tree solver.
const std::map<std::string, MeshRerun>& begins() {
  static const std::map<std::string, MeshRerun> list{
      {"tighten", MeshRerun::fields},       {"stairs", MeshRerun::fields},
      {"kernel", MeshRerun::fields},        {"projection", MeshRerun::fields},
      {"mesh_subcells", MeshRerun::fields}, {"epsilon", MeshRerun::fields},
      {"delta", MeshRerun::fields},         {"min_size", MeshRerun::fields},
      {"max_size", MeshRerun::fields},      {"sizes", MeshRerun::fields},
      {"curvature", MeshRerun::fields},     {"max_deviation", MeshRerun::fields},
      {"solver", MeshRerun::relax},         {"theta", MeshRerun::relax},
      {"iterations", MeshRerun::relax},     {"coarse_iterations", MeshRerun::relax},
      {"stagnation", MeshRerun::relax},     {"step", MeshRerun::relax},
      {"momentum", MeshRerun::relax},       {"ideal_energy", MeshRerun::relax},
      {"add_below", MeshRerun::relax},      {"delete_above", MeshRerun::relax},
      {"control_every", MeshRerun::relax},  {"particles", MeshRerun::relax},
      {"seed", MeshRerun::relax},           {"seeds", MeshRerun::relax},
      {"by_density", MeshRerun::nothing},   {"remesh", MeshRerun::triangulate},
      {"smooth", MeshRerun::triangulate},   {"triangulation", MeshRerun::triangulate},
      {"quality", MeshRerun::fields},
  };
  return list;
}

bool inside(const void* member, const void* object, std::size_t bytes) {
  const auto at = reinterpret_cast<std::uintptr_t>(member), from = reinterpret_cast<std::uintptr_t>(object);
  return at >= from && at < from + bytes;
}

const void* member_of(const Knob& knob) {
  if (const auto* choice = std::get_if<KnobChoice>(&knob.value)) return choice->member;
  return std::visit(
      [](const auto& stored) -> const void* {
        if constexpr (std::is_pointer_v<std::decay_t<decltype(stored)>>) return stored;
        return nullptr;
      },
      knob.value);
}

/// Another value that the knob may have.
std::string another(const Knob& knob) {
  if (!knob.choices.empty()) return knob.choices[knob.choices[0] == knob.text() ? 1 : 0];
  if (std::holds_alternative<bool*>(knob.value)) return *std::get<bool*>(knob.value) ? "false" : "true";
  if (std::holds_alternative<std::string*>(knob.value)) return "1:2";  // sizes
  const double now = std::stod(knob.text());
  if (std::holds_alternative<double*>(knob.value)) return std::to_string(now < knob.max ? 0.5 * (now + knob.max) : 0);
  return std::to_string(long(now) + 1);
}

TEST(MeshRerun, EveryKnobBeginsWhereItIsUsed) {
  Settings settings;
  std::size_t found = 0;
  for (const Knob& knob : knobs(settings)) {
    const bool also = knob.also && inside(knob.also, &settings.mesh, sizeof settings.mesh);
    if (!also && !inside(member_of(knob), &settings.mesh, sizeof settings.mesh)) continue;
    SCOPED_TRACE(knob.name);
    ++found;
    const auto expected = begins().find(knob.name);
    ASSERT_NE(expected, begins().end()) << "a new knob: say in mesh_rerun.cpp where it begins";
    Settings changed;
    set_knob(changed, knob.name, another(knob));
    EXPECT_EQ(mesh_rerun(settings.mesh, changed.mesh), expected->second);
    EXPECT_EQ(mesh_rerun(changed.mesh, settings.mesh), expected->second);
    EXPECT_EQ(mesh_rerun(changed.mesh, changed.mesh), MeshRerun::nothing);
  }
  EXPECT_EQ(found, begins().size());
}

/// The groups of the mesh have no knob that is neither MeshParameters' nor of what makes the volume or the cells.
TEST(MeshRerun, TheGroupsHoldNoOthers) {
  Settings settings;
  for (const Knob& knob : knobs(settings)) {
    const void* member = member_of(knob);
    EXPECT_TRUE(knob.group != "materials" || inside(member, &settings.materials, sizeof settings.materials))
        << knob.name;
    for (const char* group : {"fields", "sizing", "particles"})
      EXPECT_TRUE(knob.group != group || inside(member, &settings.mesh, sizeof settings.mesh)) << knob.name;
  }
}

TEST(MeshRerun, OtherSolversDoNotUseTheTreesKnobs) {
  MeshParameters before;
  before.solver = "redblack";
  const auto after = [&](const auto& change) {
    MeshParameters p = before;
    change(p);
    return mesh_rerun(before, p);
  };
  using P = MeshParameters;
  EXPECT_EQ(after([](P& p) { p.theta = 0.7; }), MeshRerun::nothing);
  EXPECT_EQ(after([](P& p) { p.step = 0.7; }), MeshRerun::nothing);
  EXPECT_EQ(after([](P& p) { p.momentum = 0.7; }), MeshRerun::nothing);
  EXPECT_EQ(after([](P& p) { p.by_density = false; }), MeshRerun::relax);
  EXPECT_EQ(after([](P& p) { p.theta = 0.7, p.solver = "tree"; }), MeshRerun::relax);
}

TEST(MeshRerun, TheEarliestStepCounts) {
  MeshParameters after;
  after.remesh = 1, after.theta = 0.7;
  EXPECT_EQ(mesh_rerun({}, after), MeshRerun::relax);
  after.delta = 0.3;
  EXPECT_EQ(mesh_rerun({}, after), MeshRerun::fields);
}

}  // namespace
}  // namespace nacre
