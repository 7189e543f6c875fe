// Nacre: a disk that is soon full.
#pragma once

#include <sys/mount.h>

#include <filesystem>
#include <string>

namespace nacre {

/// A memory file system of `bytes` mounted on a folder; `mounted()` is false where the user may not mount.
class SmallDisk {
 public:
  SmallDisk(std::filesystem::path folder, int bytes) : folder_(std::move(folder)) {
    const std::string size = "size=" + std::to_string(bytes);
    mounted_ = mount("none", folder_.c_str(), "tmpfs", 0, size.c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount(folder_.c_str());
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }

 private:
  std::filesystem::path folder_;
  bool mounted_ = false;
};

}  // namespace nacre
