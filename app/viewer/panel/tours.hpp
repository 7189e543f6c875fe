// Nacre: recordings that the viewer replays for newcomers.
#pragma once

namespace nacre {

/// Texts of sessions with events: assets/flow_demo.json and assets/mesh_demo.json, as they were when it was built.
extern const char* const flow_tour;
extern const char* const mesh_tour;

}  // namespace nacre
