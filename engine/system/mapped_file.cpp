// Nacre: a part of a file as memory, which the system reads when it is looked at and may forget again.
#include "engine/system/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

/// A file that was shortened has no bytes where they were mapped.
extern "C" void end_without_file(int) {
  constexpr std::string_view line = "nacre: a volume's file became shorter while it was read; start again\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
  ::_exit(1);
}

std::size_t bytes_of_page() { return std::size_t(::sysconf(_SC_PAGESIZE)); }

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path, std::size_t offset, std::size_t bytes)
    : length_(offset % bytes_of_page() + bytes), skipped_(offset % bytes_of_page()) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw Error(path.string() + " cannot be opened", std::strerror(errno), "check the file's permissions");
  void* at = ::mmap(nullptr, std::max<std::size_t>(length_, 1), PROT_READ, MAP_PRIVATE | MAP_NORESERVE, file,
                    off_t(offset - skipped_));
  const int why = errno;
  ::close(file);
  if (at == MAP_FAILED)
    throw Error(path.string() + " cannot be mapped", std::strerror(why),
                why == ENOMEM ? "allow the program more addresses (ulimit -v)" : "copy it to a local disk");
  base_ = static_cast<std::byte*>(at);
  std::signal(SIGBUS, end_without_file);
}

MappedFile::~MappedFile() { ::munmap(base_, std::max<std::size_t>(length_, 1)); }

void MappedFile::let_go(std::size_t from, std::size_t to) const {
  const std::size_t page = bytes_of_page();
  const std::size_t first = (skipped_ + from) / page * page, last = std::min(length_, (skipped_ + to) / page * page);
  if (first < last) ::madvise(base_ + first, last - first, MADV_DONTNEED);
}

}  // namespace nacre
