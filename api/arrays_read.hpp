// Nacre: which arrays of its user a run of the library has read, for results that say how they were made.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "engine/run/origin.hpp"

namespace nacre {

/// Arrays by their names, with the SHA-256 of their bytes. Any thread may add and list.
class ArraysRead {
 public:
  /// The same array at the same step again replaces the one before.
  void add(const std::string& name, std::size_t step, const void* data, std::size_t bytes);

  /// One entry for each name. Of an array that was read at several steps, these are `joined` in their order.
  std::vector<OriginFile> list() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::map<std::size_t, OriginFile>> read_;
};

/// Of a result of the library: its command is "flow" or "mesh", `output` as in Origin.
std::string library_origin(const Session& session, const std::string& command, const std::string& backend,
                           const ArraysRead& arrays, const std::string& output,
                           const std::vector<std::string>& options = {});

}  // namespace nacre
