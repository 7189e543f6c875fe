// Nacre: another program that reads what we send it.
#include "engine/picture/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "compute/device/error.hpp"

extern char** environ;

namespace nacre {
namespace fs = std::filesystem;
namespace {

void close_and_forget(int& file) {
  if (file >= 0) close(file);
  file = -1;
}

/// What the child starts with: its three streams, default signals, and a process group of its own.
class SpawnSettings {
 public:
  SpawnSettings(int input, int errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
    posix_spawnattr_init(&attributes_);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  int start(const fs::path& program, const std::vector<std::string>& arguments, pid_t& process) const {
    std::vector<char*> words{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    return posix_spawn(&process, program.c_str(), &actions_, &attributes_, words.data(), environ);
  }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

}  // namespace

fs::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    fs::path file = fs::path(folder.empty() ? "." : folder) / name;
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

ChildProcess::ChildProcess(const fs::path& program, const std::vector<std::string>& arguments) {
  // A socket and not a pipe: writing to one whose reader is gone can be told not to raise SIGPIPE.
  int ends[2] = {-1, -1};
  complaints_ = memfd_create("complaints", MFD_CLOEXEC);
  int failed = complaints_ < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0 ? errno : 0;
  input_ = ends[0];
  if (!failed) failed = SpawnSettings(ends[1], complaints_).start(program, arguments, process_);
  close_and_forget(ends[1]);
  if (!failed) return;
  close_and_forget(input_);
  close_and_forget(complaints_);
  throw Error("cannot start " + program.string(), std::strerror(failed));
}

ChildProcess::~ChildProcess() {
  if (process_ > 0) kill(process_, SIGKILL);
  wait();
  close_and_forget(complaints_);
}

bool ChildProcess::send(const void* bytes, std::size_t size) {
  const char* next = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t sent = ::send(input_, next, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return false;
    next += sent;
    size -= std::size_t(sent);
  }
  return true;
}

bool ChildProcess::wait() {
  close_and_forget(input_);
  if (process_ <= 0) return false;
  int status = 0;
  pid_t ended = -1;
  do ended = waitpid(process_, &status, 0);
  while (ended < 0 && errno == EINTR);
  const bool well = ended == process_ && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  process_ = -1;
  return well;
}

std::string ChildProcess::first_complaint() const {
  char text[512];
  const ssize_t size = pread(complaints_, text, sizeof text, 0);
  std::string line(text, size > 0 ? std::size_t(size) : 0);
  return line.substr(0, line.find_first_of("\r\n"));
}

}  // namespace nacre
