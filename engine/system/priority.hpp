// Nacre: priorities of threads, if there are fewer cores than work.
#pragma once

namespace nacre {

/// This thread, and those that it starts from now on, yield to all others: drawing comes before computing. Does nothing
/// if the system has no priorities of threads.
void make_way();

}  // namespace nacre
