// Nacre: what the child processes that read files with other libraries may do.
#pragma once

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#if defined(__SANITIZE_ADDRESS__)
/// Asked by the leak sanitizer: VTK 9.1 leaks a byte of each unstructured grid.
extern "C" __attribute__((used, visibility("default"))) inline int __lsan_is_turned_off() { return 1; }
#endif

namespace nacre {

/// A damaged file must not leave a core dump, outlive the parent, or take more memory than the machine has.
inline void limit_damage() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
#if !defined(__SANITIZE_ADDRESS__)
  const rlim_t memory = rlim_t(::sysconf(_SC_PHYS_PAGES)) * rlim_t(::sysconf(_SC_PAGE_SIZE));
  const rlimit address_space{memory, memory};
  ::setrlimit(RLIMIT_AS, &address_space);
#endif
}

}  // namespace nacre
