// Nacre: the interfaces of a field of materials as a Surface for the solvers of ch. 3.
#pragma once

#include "compute/field/inside_outside.hpp"

namespace nacre {

/// Projects by inside/outside functions (sec. 3.6); a red-black team shares the look-ups (Fig. 3.12). `Sizing` gives h
/// at a point: SizingFieldView, or anything else that is called with one.
template <class Sizing>
struct FieldSurface {
  static constexpr std::size_t team_scratch_bytes = mixed_materials * sizeof(FieldSample);

  MaterialBricksView field;
  Sizing sizing;
  const Junction* table;

  NACRE_HD float size(const Vec3f& p) const { return sizing(p); }

  NACRE_HD bool project(std::uint32_t interface, const Vec3f& p, float reach, Vec3f& on, Vec3f& direction) const {
    JunctionPoint at;
    return taken(project_by_indicator(field, table[interface], p, reach, at), at, on, direction);
  }

  template <class Group>
  NACRE_HD bool project_with_team(Group& group, unsigned char* scratch, std::uint32_t interface, const Vec3f& p,
                                  float reach, Vec3f& on, Vec3f& direction) const {
    JunctionPoint at;
    return taken(
        project_by_indicator(group, reinterpret_cast<FieldSample*>(scratch), field, table[interface], p, reach, at), at,
        on, direction);
  }

 private:
  NACRE_HD static bool taken(bool found, const JunctionPoint& at, Vec3f& on, Vec3f& direction) {
    if (found) on = at.p, direction = at.direction;
    return found;
  }
};

}  // namespace nacre
