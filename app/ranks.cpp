// Nacre: the processes that mpirun has started as one run of the program.
#include "app/ranks.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#if NACRE_HAS_MPI
#include "engine/parallel/mpi_ranks.hpp"
#endif

namespace nacre {
namespace {

std::unique_ptr<Ranks> own_ranks;

/// A number that a launcher gives its processes; 0: it is not there.
int number_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : 0;
}

/// How many processes a launcher has started; 0: none has. Open MPI's mpirun, those of MPICH's family, and Slurm with
/// either.
int started_processes() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS"})
    if (const int n = number_of(variable)) return n;
  if (std::getenv("PMIX_RANK")) return std::max(1, number_of("SLURM_NTASKS"));
  return 0;
}

/// FNV-1a over the bytes of an array.
template <class Value>
std::uint64_t hash_of(std::uint64_t hash, std::span<const Value> values) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t k = 0; k < values.size_bytes(); ++k) hash = (hash ^ bytes[k]) * 0x100000001b3;
  return hash;
}

}  // namespace

void join_run() {
  const int processes = started_processes();
  if (processes == 0) return;
#if NACRE_HAS_MPI
  own_ranks = join_mpi_ranks(&interrupt_flag());
  if (!own_ranks->first() && !std::freopen("/dev/null", "w", stdout)) throw Error("cannot open /dev/null");
#else
  if (processes > 1)
    throw UsageError("this build has no MPI: each of the processes would make the whole run; build with NACRE_MPI=ON");
#endif
}

Ranks* run_ranks() { return own_ranks.get(); }

bool is_first_process() { return !own_ranks || own_ranks->first(); }

int leave_run(int status) {
#if NACRE_HAS_MPI
  if (own_ranks && status != 0) {
    std::fflush(nullptr);
    end_mpi_ranks(status);
  }
#endif
  own_ranks.reset();
  return status;
}

void wait_for_the_first() {
  if (!is_first_process()) std::this_thread::sleep_for(std::chrono::seconds(2));
}

CommonOptions options_of_process(const CommonOptions& options) {
  CommonOptions own = options;
  const int here = std::max(number_of("OMPI_COMM_WORLD_LOCAL_SIZE"), number_of("MPI_LOCALNRANKS"));
  if (own_ranks && own.threads == 0 && here > 1)
    own.threads = std::max(1, int(std::thread::hardware_concurrency()) / here);
  if (is_first_process()) return own;
  own.quiet = true;
  own.save_session.clear();
  return own;
}

std::uint64_t first_ones(Ranks* ranks, std::uint64_t value) {
  if (!ranks) return value;
  std::uint64_t sum = ranks->first() ? value : 0;
  ranks->sum({&sum, 1});
  return sum;
}

std::string first_ones(Ranks* ranks, const std::string& text) {
  if (!ranks) return text;
  std::vector<Ranks::Bytes> send(static_cast<std::size_t>(ranks->count()));
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  if (ranks->first())
    for (Ranks::Bytes& to : send) to.assign(bytes, bytes + text.size());
  const Ranks::Bytes got = ranks->exchange(send)[0];
  return {reinterpret_cast<const char*>(got.data()), got.size()};
}

void require_same_input(Ranks& ranks, VectorsInTime& input, double start, const std::string& knobs) {
  const PreparedSurface& surface = input.surface();
  std::vector<Vec3f> vectors(surface.points.size());
  input.vectors(start, vectors);
  std::uint64_t hash = 0xcbf29ce484222325;
  hash = hash_of(hash, std::span<const Vec3d>(surface.points));
  hash = hash_of(hash, std::span<const Triangle>(surface.triangles));
  hash = hash_of(hash, std::span<const Vec3f>(vectors));
  hash = hash_of(hash, std::span<const char>(knobs));
  std::uint64_t different = first_ones(&ranks, hash) != hash;
  ranks.sum({&different, 1});
  if (different > 0)
    throw Error(std::to_string(different) + " of " + std::to_string(ranks.count()) +
                    " processes have another input than the first",
                "the files or the options differ", "give all of them the same");
}

nlohmann::json gather_reports(Ranks& ranks, const nlohmann::json& own) {
  const std::string text = own.dump();
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  std::vector<Ranks::Bytes> send(static_cast<std::size_t>(ranks.count()));
  send[0].assign(bytes, bytes + text.size());
  nlohmann::json all = nlohmann::json::array();
  for (const Ranks::Bytes& from : ranks.exchange(send)) {
    const auto* begin = reinterpret_cast<const char*>(from.data());
    if (ranks.first()) all.push_back(nlohmann::json::parse(begin, begin + from.size()));
  }
  return all;
}

}  // namespace nacre
