// Nacre: what the targets of libFuzzer share.
#include "tests/fuzz/fuzz_target.hpp"

#include <sanitizer/allocator_interface.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>

#include "compute/device/error.hpp"

namespace nacre::fuzz {
namespace {

namespace fs = std::filesystem;

std::atomic<std::size_t> in_use{0}, allowed{SIZE_MAX};

void on_malloc(const volatile void*, std::size_t size) {
  const std::size_t now = in_use.fetch_add(size) + size;
  if (now <= allowed || now > SIZE_MAX / 2) return;  // the counter may run below 0 by what was there before
  std::fprintf(stderr, "too much memory: %zu bytes in use, %zu allowed\n", now, allowed.load());
  std::abort();
}

void on_free(const volatile void* position) { in_use -= __sanitizer_get_allocated_size(position); }

/// Bounds what is allocated during its life.
class Bound {
 public:
  explicit Bound(std::size_t bytes) {
    static const int installed = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
    if (installed == 0) std::abort();
    in_use = 0;
    allowed = bytes;
  }
  ~Bound() { allowed = SIZE_MAX; }
};

/// Ends the process once `read` has used this much of its processor time: a clock would blame a busy machine.
class TimeLimit {
 public:
  explicit TimeLimit(int seconds) {
    std::signal(SIGPROF, [](int) {
      constexpr char line[] = "too slow: 10 s of processor time\n";
      [[maybe_unused]] const auto written = write(STDERR_FILENO, line, sizeof line - 1);
      std::abort();
    });
    set(seconds);
  }
  ~TimeLimit() { set(0); }
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  static void set(int seconds) {
    const itimerval limit{.it_interval = {}, .it_value = {.tv_sec = seconds, .tv_usec = 0}};
    if (setitimer(ITIMER_PROF, &limit, nullptr) != 0) std::abort();
  }
};

/// A folder of this process in memory, removed at its end.
const fs::path& folder() {
  struct Folder {
    fs::path path = fs::path(fs::exists("/dev/shm") ? "/dev/shm" : fs::temp_directory_path()) /
                    ("nacre-fuzz-" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

constexpr int seconds_allowed = 10;

template <class Read>
void survive(const Read& read) {
  try {
    const TimeLimit limit(seconds_allowed);
    read();
  } catch (const Error&) {
  } catch (const std::bad_alloc&) {
    std::fputs("memory was asked for that is not there\n", stderr);
    std::abort();
  }
}

}  // namespace

void read_as_file(const std::uint8_t* data, std::size_t size, const std::string& extension, double honest,
                  std::size_t fixed, const std::function<void(const fs::path&)>& read) {
  const fs::path file = folder() / ("input" + extension);
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), std::streamsize(size));
  const Bound bound(fixed + std::size_t(4 * honest * double(size)));
  survive([&] { read(file); });
}

void read_as_text(const std::uint8_t* data, std::size_t size, const std::function<void(const std::string&)>& read) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const Bound bound((std::size_t(4) << 20) + 256 * size);
  survive([&] { read(text); });
}

}  // namespace nacre::fuzz
