// Nacre: the processes of one run, by MPI. The only files that know it; left out of a build without it.
#pragma once

#include <atomic>
#include <memory>

#include "compute/device/ranks.hpp"

namespace nacre {

/// Joins the processes that mpirun has started. `stop`: a wait for the others ends with Interrupted once it is set;
/// null: never. When the result dies, this process leaves the others in good order. Once in a program.
std::unique_ptr<Ranks> join_mpi_ranks(const std::atomic<bool>* stop);

/// Ends all processes of the run at once, with this exit status.
[[noreturn]] void end_mpi_ranks(int status);

}  // namespace nacre
