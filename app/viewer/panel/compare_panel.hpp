// Nacre: what a second view shows beside the first, as widgets.
#pragma once

#include "engine/scene/session/session.hpp"

namespace nacre {

/// In the tab "look": the knobs in which the second view differs, one more of them, and what the two can exchange.
void compare_section(Session& session);

}  // namespace nacre
