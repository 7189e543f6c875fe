// Nacre: a part of a file as memory, which the system reads when it is looked at and may forget again.
#pragma once

#include <cstddef>
#include <filesystem>

#include "compute/field/material_array.hpp"

namespace nacre {

/// Bytes of a file that must not change as long as this lives. One that becomes shorter ends the program, with status 1
/// and one line.
class MappedFile : public HeldBytes {
 public:
  /// `bytes` of it from `offset` on. Throws Error where that cannot be.
  MappedFile(const std::filesystem::path& path, std::size_t offset, std::size_t bytes);
  ~MappedFile() override;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  const std::byte* data() const override { return base_ + skipped_; }
  void let_go(std::size_t from, std::size_t to) const override;

 private:
  std::byte* base_ = nullptr;  ///< at the beginning of a page
  std::size_t length_ = 0;     ///< from there
  std::size_t skipped_ = 0;    ///< of the first page
};

}  // namespace nacre
