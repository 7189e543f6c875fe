// Nacre: presets: many knobs at once, under a name.
#pragma once

#include "engine/scene/session/session.hpp"

namespace nacre {

/// The constants of the thesis (docs/method.md), but for the kernel, which depends on the volume.
void apply_thesis_preset(Settings& settings);

/// The kernel of the thesis: B-splines for volumes that are cut at iso-values, Catmull-Rom for labels and
/// indicators.
void apply_thesis_kernel(Settings& settings, bool cut_at_isovalues);

/// Will the volume of this session be cut at iso-values? Known before it is read.
bool is_cut_at_isovalues(const Session& session);

}  // namespace nacre
