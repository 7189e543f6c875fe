// Nacre: priorities of threads.
#include "engine/system/priority.hpp"

#include <sys/resource.h>

namespace nacre {

void make_way() {
#ifdef __linux__  // elsewhere this would be the whole process
  constexpr int this_thread = 0, nice = 10;
  setpriority(PRIO_PROCESS, this_thread, nice);
#endif
}

}  // namespace nacre
