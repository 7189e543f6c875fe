// Nacre: the values of a flow from all processes that share it.
#include "compute/pipeline/gather_values.hpp"

#include <cstring>
#include <vector>

namespace nacre {
namespace {

template <class Value>
void gather(Ranks& ranks, std::vector<Value>& values) {
  std::vector<Ranks::Bytes> send(static_cast<std::size_t>(ranks.count()));
  const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
  if (!ranks.first()) send[0].assign(bytes, bytes + values.size() * sizeof(Value));
  if (!ranks.first()) values.clear();
  for (const Ranks::Bytes& from : ranks.exchange(send)) {
    const std::size_t n = values.size();
    values.resize(n + from.size() / sizeof(Value));
    if (!from.empty()) std::memcpy(static_cast<void*>(values.data() + n), from.data(), from.size());
  }
}

}  // namespace

void gather_values(Ranks& ranks, FlowValues& values) {
  gather(ranks, values.centre);
  gather(ranks, values.value);
  gather(ranks, values.velocity);
  gather(ranks, values.normal);
  gather(ranks, values.closest_point);
}

}  // namespace nacre
