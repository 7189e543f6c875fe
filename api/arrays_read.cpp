// Nacre: which arrays of its user a run of the library has read.
#include "api/arrays_read.hpp"

#include "engine/system/sha256.hpp"

namespace nacre {

void ArraysRead::add(const std::string& name, std::size_t step, const void* data, std::size_t bytes) {
  Sha256 hash;
  hash.add(data, bytes);
  const std::scoped_lock lock(mutex_);
  read_[name][step] = {name, bytes, hash.finish()};
}

std::vector<OriginFile> ArraysRead::list() const {
  const std::scoped_lock lock(mutex_);
  std::vector<OriginFile> arrays;
  for (const auto& [name, steps] : read_) {
    if (steps.size() == 1) {
      arrays.push_back(steps.begin()->second);
      continue;
    }
    Sha256 hash;
    std::uintmax_t bytes = 0;
    for (const auto& [step, each] : steps) {
      hash.add(each.sha256.data(), each.sha256.size());
      bytes += each.bytes;
    }
    arrays.push_back({name, bytes, hash.finish()});
  }
  return arrays;
}

std::string library_origin(const Session& session, const std::string& command, const std::string& backend,
                           const ArraysRead& arrays, const std::string& output,
                           const std::vector<std::string>& options) {
  Origin origin = origin_of(session, command, backend, {});
  origin.arrays = arrays.list();
  origin.output = output;
  origin.options = options;
  return origin_text(origin);
}

}  // namespace nacre
