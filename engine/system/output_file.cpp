// Nacre: files that appear under their name only when they are complete.
#include "engine/system/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_bytes = std::size_t(1) << 18;

struct Registry {
  std::mutex mutex;
  std::set<fs::path> paths;  ///< absolute

  /// The caller holds the mutex.
  void remove_all() {
    std::error_code ignored;
    for (const fs::path& path : paths) fs::remove_all(path, ignored);
    paths.clear();
  }
};

Registry& registry() {
  static Registry* instance = new Registry;  // never destroyed: files may be committed while statics are
  return *instance;
}

/// A name that no other file of this or another running program has.
fs::path fresh_name_beside(const fs::path& destination) {
  static std::atomic<unsigned> counter{0};
  return destination.parent_path() /
         fmt::format(".nacre-{}-{}{}", ::getpid(), counter++, destination.extension().string());
}

/// The file to which a link leads, so that a rename replaces the file and not the link.
fs::path follow_links(const fs::path& target) {
  constexpr int longest_chain = 40;
  std::error_code error;
  fs::path file = target;
  for (int i = 0; i < longest_chain && fs::is_symlink(fs::symlink_status(file, error)); ++i)
    file = file.parent_path() / fs::read_symlink(file, error);
  return file;
}

fs::path absolute_name(const fs::path& path) {
  std::error_code error;
  fs::path all = fs::absolute(path, error);
  return error ? path : all;
}

/// A new file that is on the list from the beginning: what fails between the two leaves nothing behind. Returns what
/// `open` returns.
int open_listed(const fs::path& file) {
  const std::lock_guard lock(registry().mutex);
  const auto [listed, is_new] = registry().paths.insert(absolute_name(file));
  const int handle = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  const int error_number = errno;
  if (handle < 0 && is_new) registry().paths.erase(listed);
  errno = error_number;
  return handle;
}

std::string reason(int error_number) {
  return error_number != 0 ? std::generic_category().message(error_number) : "only a part could be written";
}

}  // namespace

const char* advice_on_writing(int error_number) {
  switch (error_number) {
    case ENOENT:
    case ENOTDIR: return "create the folder first or choose another one";
    case EACCES:
    case EPERM:
    case EROFS: return "choose a folder that you may write to";
    case ENOSPC:
    case EDQUOT: return "free some space or choose another disk";
    case EFBIG: return "raise the file size limit or write a smaller file";
    case EISDIR: return "give the name of a file";
    case ENAMETOOLONG: return "choose a shorter name";
    default: return "";
  }
}

OutputFile::OutputFile(fs::path target, Devices devices)
    : target_(std::move(target)), destination_(follow_links(target_)) {
  std::error_code error;
  const fs::file_status status = fs::status(destination_, error);
  const bool plain = destination_.has_filename() && (!fs::exists(status) || fs::is_regular_file(status));
  if (devices == Devices::refused && !plain)
    throw Error("cannot write " + target_.string(), "it is not a regular file", "give the name of a file");
  if (target_.empty()) fail(ENOENT);
  if (error == std::errc::filename_too_long) fail(ENAMETOOLONG);
  if (fs::is_directory(status) || !destination_.has_filename()) fail(EISDIR);
  direct_ = fs::exists(status) && !fs::is_regular_file(status);
  if (fs::exists(status) && ::access(destination_.c_str(), W_OK) != 0) fail(errno);

  int handle = -1;
  if (direct_) {
    temporary_ = destination_;
    handle = ::open(temporary_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    do {
      temporary_ = fresh_name_beside(destination_);
      handle = open_listed(temporary_);
    } while (handle < 0 && errno == EEXIST);
  }
  if (handle < 0) fail(errno);
  stream_ = ::fdopen(handle, "wb");
  if (!stream_) {
    const int error_number = errno;
    ::close(handle);
    remove_temporary();
    fail(error_number);
  }
  std::setvbuf(stream_, nullptr, _IOFBF, buffer_bytes);
}

OutputFile::~OutputFile() {
  if (!stream_) return;
  std::fclose(stream_);
  remove_temporary();
}

void OutputFile::remove_temporary() const {
  if (direct_) return;
  ::unlink(temporary_.c_str());
  drop_unfinished(temporary_);
}

void OutputFile::write(const void* data, std::size_t bytes) {
  errno = 0;
  if (bytes > 0 && std::fwrite(data, 1, bytes, stream_) != bytes) fail(errno);
}

void OutputFile::sync() {
  errno = 0;
  if (std::fflush(stream_) != 0 || (!direct_ && ::fsync(::fileno(stream_)) != 0)) fail(errno);
}

void OutputFile::commit() {
  errno = 0;
  const bool lost = std::fflush(stream_) != 0 || std::ferror(stream_) != 0;
  if (lost) fail(errno);
  struct stat existing;
  if (!direct_ && ::stat(destination_.c_str(), &existing) == 0)  // a replaced file keeps its permissions
    if (::fchmod(::fileno(stream_), existing.st_mode & 07777) != 0) fail(errno);
  std::FILE* stream = std::exchange(stream_, nullptr);
  int error_number = std::fclose(stream) == 0 ? 0 : errno;
  if (direct_) {
    if (error_number != 0) fail(error_number);
    return;
  }
  if (error_number == 0 && std::rename(temporary_.c_str(), destination_.c_str()) != 0) error_number = errno;
  if (error_number != 0) ::unlink(temporary_.c_str());
  drop_unfinished(temporary_);
  if (error_number != 0) fail(error_number);
}

void OutputFile::fail(int error_number) const {
  throw Error(fmt::format("cannot write {}", target_.empty() ? "a file without a name" : target_.string()),
              reason(error_number), advice_on_writing(error_number));
}

void check_writable(const fs::path& target) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) return;
  const OutputFile probe(target);
}

void add_unfinished(const fs::path& path) {
  const fs::path name = absolute_name(path);
  const std::lock_guard lock(registry().mutex);
  registry().paths.insert(name);
}

void drop_unfinished(const fs::path& path) noexcept try {
  const fs::path name = absolute_name(path);
  const std::lock_guard lock(registry().mutex);
  registry().paths.erase(name);
} catch (...) {  // out of memory: an unnecessary name on the list does no harm
}

void remove_unfinished_files() noexcept try {
  const std::lock_guard lock(registry().mutex);
  registry().remove_all();
} catch (...) {  // on exit: nothing better can be done
}

void leave_without_unfinished_files(int status) noexcept {
  try {
    const std::lock_guard lock(registry().mutex);
    registry().remove_all();
    ::_exit(status);  // while no other thread can begin another file
  } catch (...) {
    ::_exit(status);
  }
}

}  // namespace nacre
