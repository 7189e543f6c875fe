// Nacre: several processes that make one flow run together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "export.hpp"

namespace nacre {

/// Processes 0 .. count() - 1 that share a flow run, of which this is one: for example those of a communicator of MPI.
/// Nacre links no MPI; derive from this with four calls of yours (examples/flow_by_mpi.cpp). All processes create the
/// run and call its members in the same order, with the same arguments. The members below are called by the thread
/// that runs the job. What they throw ends the run in this process; ending the others is up to the caller (MPI_Abort).
class NACRE_API Processes {
 public:
  /// Bytes that go to another process, or come from there; both sides know how many.
  struct Part {
    int rank;
    std::span<std::byte> bytes;
  };

  virtual ~Processes() = default;
  virtual int rank() const = 0;
  virtual int count() const = 0;
  /// Replaces each number by its sum over all processes, modulo 2^64.
  virtual void sum(std::span<std::uint64_t> numbers) = 0;
  /// Sends and receives; returns when both are done. At most one part for each other process on either side.
  virtual void exchange(std::span<const Part> send, std::span<const Part> receive) = 0;
};

}  // namespace nacre
