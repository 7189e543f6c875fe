// Nacre: which threads come first where there are fewer cores than work.
#pragma once

namespace nacre {

/// This thread, and those that it starts from now on, take what the others leave: drawing comes before computing. Does
/// nothing where the system knows no priorities of threads.
void make_way();

}  // namespace nacre
