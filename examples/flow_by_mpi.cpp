// Nacre: the processes of MPI make one flow run together. Usage: mpirun -n 4 flow_by_mpi PREFIX
#include <mpi.h>

#include <array>
#include <cstdio>
#include <nacre/flow.hpp>
#include <nacre/processes.hpp>
#include <string>
#include <vector>

namespace {

/// What Nacre needs of a communicator.
class Communicator final : public nacre::Processes {
 public:
  explicit Communicator(MPI_Comm comm) : comm_(comm) {
    MPI_Comm_rank(comm, &rank_);
    MPI_Comm_size(comm, &count_);
  }
  int rank() const override { return rank_; }
  int count() const override { return count_; }

  void sum(std::span<std::uint64_t> numbers) override {
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), int(numbers.size()), MPI_UINT64_T, MPI_SUM, comm_);
  }

  void exchange(std::span<const Part> send, std::span<const Part> receive) override {
    std::vector<MPI_Request> requests;
    for (const Part& part : receive)  // parts of 2 GB and more would have to be cut
      MPI_Irecv(part.bytes.data(), int(part.bytes.size()), MPI_BYTE, part.rank, 0, comm_, &requests.emplace_back());
    for (const Part& part : send)
      MPI_Isend(part.bytes.data(), int(part.bytes.size()), MPI_BYTE, part.rank, 0, comm_, &requests.emplace_back());
    MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  }

 private:
  MPI_Comm comm_;
  int rank_ = 0, count_ = 1;
};

/// A wavy sheet with a flow that turns about its middle.
nacre::SurfaceFlow sheet() {
  nacre::SurfaceFlow flow;
  constexpr unsigned n = 100;
  for (unsigned i = 0; i < n * n; ++i) {
    const double x = 2.0 * (i % n) / (n - 1) - 1, y = 2.0 * (i / n) / (n - 1) - 1;
    flow.points.push_back({x, y, 0.2 * x * x * y});
  }
  for (unsigned i = 0; i + n < n * n; ++i) {
    if (i % n + 1 == n) continue;
    flow.triangles.push_back({i, i + 1, i + n + 1});
    flow.triangles.push_back({i, i + n + 1, i + n});
  }
  const std::vector<std::array<double, 3>> points = flow.points;
  flow.vectors = [points](std::size_t, std::span<float> out) {
    for (std::size_t i = 0; i < points.size(); ++i)
      out[3 * i] = float(-points[i][1]), out[3 * i + 1] = float(points[i][0]), out[3 * i + 2] = 0;
  };
  return flow;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int status = 0;
  try {
    Communicator world(MPI_COMM_WORLD);
    nacre::RunOptions options;
    options.processes = &world;
    options.threads = 1;
    nacre::Flow flow(sheet(), {{"method", "octree"}, {"resolution", 200}, {"steps", 3}}, options);
    const std::string prefix = argc > 1 ? argv[1] : "sheet";
    while (flow.step()) {
      const nacre::FlowPicture picture = flow.picture();  // by all of them, and all of them get it
      if (world.rank() == 0) nacre::save(prefix + std::to_string(flow.frame()) + ".png", picture);
    }
    flow.save(prefix + ".pvtp");  // each process its own cells
  } catch (const nacre::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    status = 1;
  }
  if (status != 0) MPI_Abort(MPI_COMM_WORLD, status);  // the others may wait for this process
  MPI_Finalize();
}
