// Nacre: faults injected into a running program by LD_PRELOAD, each at the n-th call of its kind, so that a run fails
// at the same call every time. NACRE_FAULT is KIND:N, or none to count only; NACRE_FAULT_COUNTS names a file that gets
// the number of calls of each kind. Counting begins when main installs its signal handlers: what fails before, the C++
// library cannot survive.
//   new      the N-th operator new throws std::bad_alloc
//   malloc   the N-th malloc, calloc, realloc or posix_memalign returns null
//   write    the N-th fwrite, fflush, fclose, rename or fchmod of the program's own files fails: the disk is full
//   SIGNAL   SIGINT or SIGTERM is raised at the N-th operator new
//   replace  before the N-th time that the file NACRE_FAULT_FILE is opened, NACRE_FAULT_OTHER takes its place
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* position, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

enum Kind { of_new, of_malloc, of_write, of_sigint, of_sigterm, of_replace, kinds };
constexpr const char* names[kinds] = {"new", "malloc", "write", "SIGINT", "SIGTERM", "replace"};

std::atomic<bool> armed{false};
std::atomic<long> calls[kinds];
int wanted = kinds;
long when = 0;

void read_wish() {
  const char* wish = std::getenv("NACRE_FAULT");
  if (!wish) return;
  for (int kind = 0; kind < kinds; ++kind) {
    const std::size_t length = std::strlen(names[kind]);
    if (std::strncmp(wish, names[kind], length) == 0 && wish[length] == ':') {
      wanted = kind;
      when = std::atol(wish + length + 1);
    }
  }
}

bool due(Kind kind) {
  if (!armed.load(std::memory_order_relaxed)) return false;
  const long call = calls[kind].fetch_add(1, std::memory_order_relaxed) + 1;
  return kind == wanted && call == when;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

struct Counts {
  ~Counts() {
    const char* file = std::getenv("NACRE_FAULT_COUNTS");
    armed = false;
    std::FILE* out = file ? std::fopen(file, "w") : nullptr;
    if (!out) return;
    for (int kind = 0; kind < kinds; ++kind) std::fprintf(out, "%s %ld\n", names[kind], calls[kind].load());
    std::fclose(out);
  }
} counts_at_exit;

void* allocate(std::size_t size, std::size_t alignment) {
  if (due(of_sigint)) raise(SIGINT);
  if (due(of_sigterm)) raise(SIGTERM);
  if (due(of_new)) throw std::bad_alloc();
  void* position = alignment == 0 ? __libc_malloc(size) : __libc_memalign(alignment, size);
  if (!position) throw std::bad_alloc();
  return position;
}

bool is_own(std::FILE* stream) { return stream != stdout && stream != stderr && stream != nullptr; }

bool disk_is_full(std::FILE* stream) {
  if (!is_own(stream) || !due(of_write)) return false;
  errno = ENOSPC;
  return true;
}

void replace_if_due(const char* file) {
  const char* watched = std::getenv("NACRE_FAULT_FILE");
  const char* other = std::getenv("NACRE_FAULT_OTHER");
  if (watched && other && std::strcmp(file, watched) == 0 && due(of_replace))
    next<int (*)(const char*, const char*)>("rename")(other, watched);
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size, 0); }
void* operator new[](std::size_t size) { return allocate(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) { return allocate(size, std::size_t(alignment)); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return allocate(size, std::size_t(alignment)); }

extern "C" {

int sigaction(int signal, const struct sigaction* action, struct sigaction* before) noexcept {
  if (signal == SIGINT && action && !armed) {
    read_wish();
    armed = true;
  }
  return next<int (*)(int, const struct sigaction*, struct sigaction*)>("sigaction")(signal, action, before);
}

void* malloc(std::size_t size) {
  if (due(of_malloc)) return errno = ENOMEM, nullptr;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  if (due(of_malloc)) return errno = ENOMEM, nullptr;
  return __libc_calloc(count, size);
}
void* realloc(void* position, std::size_t size) {
  if (due(of_malloc)) return errno = ENOMEM, nullptr;
  return __libc_realloc(position, size);
}
int posix_memalign(void** position, std::size_t alignment, std::size_t size) {
  if (due(of_malloc)) return ENOMEM;
  *position = __libc_memalign(alignment, size);
  return *position ? 0 : ENOMEM;
}

std::size_t fwrite(const void* data, std::size_t size, std::size_t count, std::FILE* stream) {
  if (disk_is_full(stream)) return 0;
  return next<std::size_t (*)(const void*, std::size_t, std::size_t, std::FILE*)>("fwrite")(data, size, count, stream);
}
int fflush(std::FILE* stream) {
  if (disk_is_full(stream)) return EOF;
  return next<int (*)(std::FILE*)>("fflush")(stream);
}
int fclose(std::FILE* stream) {
  const bool full = disk_is_full(stream);
  const int result = next<int (*)(std::FILE*)>("fclose")(stream);
  if (!full) return result;
  errno = ENOSPC;
  return EOF;
}
int rename(const char* from, const char* to) noexcept {
  if (due(of_write)) return errno = EIO, -1;
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}
int fchmod(int handle, mode_t mode) noexcept {
  if (due(of_write)) return errno = EIO, -1;
  return next<int (*)(int, mode_t)>("fchmod")(handle, mode);
}

std::FILE* fopen(const char* file, const char* mode) {
  replace_if_due(file);
  return next<std::FILE* (*)(const char*, const char*)>("fopen")(file, mode);
}
std::FILE* fopen64(const char* file, const char* mode) {
  replace_if_due(file);
  return next<std::FILE* (*)(const char*, const char*)>("fopen64")(file, mode);
}
int open(const char* file, int flags, ...) {
  replace_if_due(file);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_t(flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, int) : 0);
  va_end(rest);
  return next<int (*)(const char*, int, ...)>("open")(file, flags, mode);
}
int open64(const char* file, int flags, ...) {
  replace_if_due(file);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_t(flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, int) : 0);
  va_end(rest);
  return next<int (*)(const char*, int, ...)>("open64")(file, flags, mode);
}

}  // extern "C"
