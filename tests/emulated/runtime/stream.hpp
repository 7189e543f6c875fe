// Nacre: streams, graphs and events of the emulated device, and the state that all calls share.
#pragma once

#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "cuda_runtime_api.h"

namespace emulated {

/// What waits in a stream, or a node of a graph.
struct Node {
  std::string kind;  ///< for graphs: which of them can be updated to which
  std::function<void()> run;
  Event* event = nullptr;  ///< that it records
};

struct Event {
  int pending = 0;  ///< how often it waits in a stream
  bool recorded = false;
  double time = 0;  ///< s
};

struct Graph {
  std::vector<Node> nodes;
};

/// Nothing in it runs before somebody waits for it: a missing wait shows.
struct Stream {
  std::deque<Node> queue;
  Graph* captured = nullptr;  ///< while it is captured
  std::thread::id capturing_thread;
  bool capture_broken = false;

  void run_all();
};

/// One lock for all calls; recursive, since what runs in a stream is held by the call that waits.
std::recursive_mutex& lock();

/// Remembers the failure for cudaGetLastError. What is not allowed during a capture ends the capture.
cudaError_t fail(cudaError_t error);

/// Does this thread capture? Then most calls are not allowed to it.
bool this_thread_captures();

cudaError_t append(Stream* stream, Node node);
void run_all_streams();

}  // namespace emulated
