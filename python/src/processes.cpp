// Nacre: the processes of mpi4py's communicator.
#include "processes.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace nacre::python {
namespace {

/// Memory that Python may read and write while the call goes on.
nb::object view_of(std::span<std::byte> bytes) {
  return nb::steal(
      PyMemoryView_FromMemory(reinterpret_cast<char*>(bytes.data()), Py_ssize_t(bytes.size()), PyBUF_WRITE));
}

nb::list list_of(std::span<const Processes::Part> parts) {
  nb::list list;
  for (const Processes::Part& part : parts) list.append(nb::make_tuple(part.rank, view_of(part.bytes)));
  return list;
}

/// An object that is let go with the interpreter's lock.
struct Held {
  nb::object object;
  ~Held() {
    nb::gil_scoped_acquire hold;
    object.reset();
  }
};

}  // namespace

PythonProcesses::PythonProcesses(Worker& worker, nb::handle processes)
    : worker_(worker),
      processes_(processes),
      rank_(nb::cast<int>(processes.attr("rank"))),
      count_(nb::cast<int>(processes.attr("count"))) {}

void PythonProcesses::wait_for(const std::function<nb::object()>& begin) {
  Held requests;
  worker_.with_python([&] { requests.object = begin(); });
  const auto begun = std::chrono::steady_clock::now();
  for (auto pause = std::chrono::microseconds(20);; pause = std::min(pause * 2, std::chrono::microseconds(1000))) {
    bool done = false;
    worker_.with_python([&] { done = nb::cast<bool>(processes_.attr("done")(requests.object)); });
    if (done) return;
    if (std::chrono::steady_clock::now() - begun > std::chrono::microseconds(200)) std::this_thread::sleep_for(pause);
  }
}

void PythonProcesses::sum(std::span<std::uint64_t> numbers) {
  wait_for([&] { return processes_.attr("begin_sum")(view_of(std::as_writable_bytes(numbers))); });
}

void PythonProcesses::exchange(std::span<const Part> send, std::span<const Part> receive) {
  wait_for([&] { return processes_.attr("begin_exchange")(list_of(send), list_of(receive)); });
}

}  // namespace nacre::python
