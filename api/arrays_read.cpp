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
    std::vector<OriginFile> parts;
    for (const auto& [step, each] : steps) parts.push_back(each);
    arrays.push_back(parts.size() == 1 ? parts[0] : joined(name, parts));
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
