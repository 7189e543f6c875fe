// Nacre: a file that appears under its name only once it is whole.
#include "engine/picture/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <system_error>

#include "compute/device/error.hpp"

namespace nacre {
namespace fs = std::filesystem;
namespace {

/// The file that a link leads to, so that a rename replaces the file and not the link.
fs::path behind_links(const fs::path& target) {
  constexpr int longest_chain = 40;
  std::error_code failed;
  fs::path file = target;
  for (int i = 0; i < longest_chain && fs::is_symlink(fs::symlink_status(file, failed)); ++i)
    file = file.parent_path() / fs::read_symlink(file, failed);
  return file;
}

}  // namespace

const char* advice_on_writing(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT: return "free some space or choose another disk";
    case EFBIG: return "choose a smaller size, or raise the limit on file sizes";
    case ENOENT:
    case ENOTDIR: return "make the folder first, or choose another";
    case EACCES:
    case EPERM:
    case EROFS: return "choose a folder that you may write to";
    case ENAMETOOLONG: return "choose a shorter name";
    default: return "";
  }
}

void fail_to_write(const fs::path& file, int error) {
  throw Error("cannot write " + file.string(), std::strerror(error), advice_on_writing(error));
}

OutputFile::OutputFile(const fs::path& target) : target_(behind_links(target)) {
  static std::atomic<unsigned> count = 0;
  std::error_code ignored;
  const fs::file_status status = fs::status(target_, ignored);
  if (target_.filename().empty() || (fs::exists(status) && !fs::is_regular_file(status)))
    throw Error("cannot write " + target.string(), "it is not a plain file", "give the name of a file");

  // A name cut to 200 bytes leaves room for what is added to it.
  const std::string name = "." + target_.filename().string().substr(0, 200);
  int file = -1;
  do {
    const std::string suffix = "." + std::to_string(getpid()) + "-" + std::to_string(count++) + ".part";
    temporary_ = target_.parent_path() / (name + suffix);
    file = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (file < 0 && errno == EEXIST);
  if (file < 0) fail_to_write(target, errno);
  close(file);
}

OutputFile::~OutputFile() {
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void OutputFile::commit() {
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail_to_write(target_, errno);
  temporary_.clear();
}

}  // namespace nacre
