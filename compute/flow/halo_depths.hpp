// Nacre: how deep a process knows what lies around its bricks, so that no path of a particle and no streak leaves it.
#pragma once

namespace nacre {

/// In bricks, counted along every axis from the bricks that a process owns.
struct HaloDepths {
  int deposits = 1;  ///< where particles of its own bricks leave deposits
  int beside = 1;    ///< where a cell that nothing reached looks for paths that crossed, and smoothing for streaks
  int detail = 1;    ///< where sharpening asks for values
  int whole = 5;     ///< all that is kept: what streaks see, a brick around `detail` for local contrast, pixels

  /// For a band of `radius` cells; displacements of up to 2 `step_cells` texture cells a step; streaks of `streaks`
  /// cells each way.
  static HaloDepths of(double radius, double step_cells, int streaks);
};

}  // namespace nacre
