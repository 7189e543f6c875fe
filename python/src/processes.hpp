// Nacre: the processes of mpi4py's communicator, as python/nacre/_processes.py gives them.
#pragma once

#include <nacre/processes.hpp>

#include "worker.hpp"

namespace nacre::python {

/// Messages are begun and looked after by Python, on the thread of the run. While it waits, Ctrl-C ends the run.
class PythonProcesses final : public Processes {
 public:
  /// `processes`: a nacre._processes.Processes; worker and object have to outlive this.
  PythonProcesses(Worker& worker, nb::handle processes);

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  void sum(std::span<std::uint64_t> numbers) override;
  void exchange(std::span<const Part> send, std::span<const Part> receive) override;

 private:
  /// Until what `begin` has begun has ended.
  void wait_for(const std::function<nb::object()>& begin);

  Worker& worker_;
  nb::handle processes_;
  int rank_, count_;
};

}  // namespace nacre::python
