// Nacre: the processes that mpirun has started as one run of the program.
#pragma once

#include "app/common.hpp"
#include "compute/device/ranks.hpp"

namespace nacre {

/// Joins the others, if mpirun has started this process: once, before anything is printed. From then on only the first
/// process has a standard output. Throws UsageError where there are several and this build has no MPI.
void join_run();

/// The processes of this run; null where it was not started by mpirun.
Ranks* run_ranks();

/// Whether this process prints and writes: the first one, or the only one.
bool is_first_process();

/// The last thing that a process does: takes leave of the others, or ends all of them where `status` is not 0.
int leave_run(int status);

/// Before a process says why it fails: all may fail alike, then the first one's line is enough.
void wait_for_the_first();

/// What the command's options are for this process: those that do not come first are quiet and write nothing by
/// themselves, and the processes of one machine share its threads.
CommonOptions options_of_process(const CommonOptions& options);

}  // namespace nacre
