// Nacre: the processes that mpirun has started as one run of the program.
#include "app/ranks.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

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

}  // namespace nacre
