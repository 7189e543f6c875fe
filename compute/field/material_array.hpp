// Nacre: the material of each voxel, from labels that are held only once: in memory or in a file that is mapped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace nacre {

/// Bytes that somebody else holds.
class HeldBytes {
 public:
  virtual ~HeldBytes() = default;
  virtual const std::byte* data() const = 0;
  /// Bytes `from` to `to` are not needed soon: a mapped file need not keep them in memory.
  virtual void let_go(std::size_t /*from*/, std::size_t /*to*/) const {}
};

/// Materials of voxels, x fastest: as numbers of their own, or as labels of one or two bytes and a table.
class MaterialArray {
 public:
  MaterialArray() = default;
  MaterialArray(std::vector<std::uint16_t> own) : own_(std::move(own)) {}  // NOLINT: a conversion
  /// `labels` begins with `size` labels of `width` bytes. One with the bits b is material table[b]; table has 256 or
  /// 65536 entries. `counts`: voxels per material.
  MaterialArray(std::shared_ptr<const HeldBytes> labels, int width, std::size_t size, std::vector<std::uint16_t> table,
                std::vector<std::int64_t> counts)
      : labels_(std::move(labels)), width_(width), size_(size), table_(std::move(table)), counts_(std::move(counts)) {}

  std::size_t size() const { return labels_ ? size_ : own_.size(); }
  bool empty() const { return size() == 0; }
  std::uint16_t operator[](std::size_t i) const {
    if (!labels_) return own_[i];
    return width_ == 1 ? table_[bytes()[i]] : table_[words()[i]];
  }

  /// use(values, table): the values in their type, and what each one means; no table where they are the materials.
  template <class Use>
  void visit(const Use& use) const {
    if (!labels_)
      use(own_.data(), static_cast<const std::uint16_t*>(nullptr));
    else if (width_ == 1)
      use(bytes(), table_.data());
    else
      use(words(), table_.data());
  }

  /// Those of `count` voxels from `first` on.
  void read(std::size_t first, std::size_t count, std::uint16_t* to) const;
  std::vector<std::uint16_t> copy() const;
  /// Voxels `first` to `last` are not needed soon.
  void let_go(std::size_t first, std::size_t last) const {
    if (labels_) labels_->let_go(first * std::size_t(width_), last * std::size_t(width_));
  }

  /// Numbers of their own, to be changed; made from the labels where there were none.
  std::vector<std::uint16_t>& own();
  bool is_own() const { return !labels_; }
  const std::vector<std::uint16_t>& numbers() const { return own_; }  ///< where they are their own

  /// Voxels per material, of which there are so many.
  std::vector<std::int64_t> counts(int materials) const;
  bool all_outside() const;  ///< no voxel is of another material than 0

 private:
  const std::uint8_t* bytes() const { return reinterpret_cast<const std::uint8_t*>(labels_->data()); }
  const std::uint16_t* words() const { return reinterpret_cast<const std::uint16_t*>(labels_->data()); }

  std::vector<std::uint16_t> own_;
  std::shared_ptr<const HeldBytes> labels_;
  int width_ = 2;
  std::size_t size_ = 0;
  std::vector<std::uint16_t> table_;
  std::vector<std::int64_t> counts_;
};

}  // namespace nacre
