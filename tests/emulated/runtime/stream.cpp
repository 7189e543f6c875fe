// Nacre: streams, graphs and events of the emulated device.
#include "tests/emulated/runtime/stream.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <utility>

#include "tests/emulated/runtime/grid_run.hpp"
#include "tests/emulated/runtime/settings.hpp"

namespace emulated {
namespace {

cudaError_t last_error = cudaSuccess;
std::vector<Stream*> streams;
thread_local Stream* captured_here = nullptr;
thread_local cudaStreamCaptureMode mode_here = cudaStreamCaptureModeThreadLocal;
int captures_to_break = 0;
long launches_so_far = 0;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct LoadedKernel {
  bool loaded = false;
  std::size_t shared_bytes = 0;  ///< allowed
};
LoadedKernel& kernel(const void* function) {
  static std::map<const void*, LoadedKernel> all;
  return all[function];
}

}  // namespace

std::recursive_mutex& lock() {
  static std::recursive_mutex mutex;
  return mutex;
}

cudaError_t fail(cudaError_t error) {
  const bool forbidden = error == cudaErrorStreamCaptureUnsupported || error == cudaErrorStreamCaptureImplicit;
  if (captured_here && forbidden) captured_here->capture_broken = true;
  return last_error = error;
}

bool this_thread_captures() { return captured_here && mode_here != cudaStreamCaptureModeRelaxed; }

void break_captures(int count) {
  const std::scoped_lock held(lock());
  captures_to_break = count;
}

long launches() {
  const std::scoped_lock held(lock());
  return launches_so_far;
}

void Stream::run_all() {
  while (!queue.empty()) {
    Node node = std::move(queue.front());
    queue.pop_front();
    node.run();
    if (node.event) --node.event->pending;
  }
}

void run_all_streams() {
  for (Stream* stream : streams) stream->run_all();
}

cudaError_t append(Stream* stream, Node node) {
  const std::scoped_lock held(lock());
  if (!stream) {
    if (this_thread_captures()) return fail(cudaErrorStreamCaptureImplicit);
    broken("work for the default stream, which waits for all others", node.kind);
  }
  if (stream->captured) {
    if (stream->capturing_thread != std::this_thread::get_id()) return fail(cudaErrorStreamCaptureWrongThread);
    stream->captured->nodes.push_back(std::move(node));
    return cudaSuccess;
  }
  if (this_thread_captures()) broken("work beside the capture, which would overtake what is captured", node.kind);
  if (node.event) ++node.event->pending;
  stream->queue.push_back(std::move(node));
  return cudaSuccess;
}

cudaError_t enqueue(cudaStream_t stream, std::string kind, std::function<void()> work) {
  return append(stream, {std::move(kind), std::move(work), nullptr});
}

cudaError_t allow_shared_memory(const void* function, int bytes) {
  const std::scoped_lock held(lock());
  if (bytes < 0 || std::size_t(bytes) > shared_limit) return fail(cudaErrorInvalidValue);
  kernel(function).shared_bytes = std::size_t(bytes);
  return cudaSuccess;
}

cudaError_t load_kernel(const void* function) {
  const std::scoped_lock held(lock());
  if (!kernel(function).loaded && this_thread_captures()) return fail(cudaErrorStreamCaptureUnsupported);
  kernel(function).loaded = true;
  return cudaSuccess;
}

void launch(const Launch& launch, cudaStream_t stream, std::function<void()> lane) {
  const std::scoped_lock held(lock());
  const std::size_t allowed = std::max(shared_unasked, kernel(launch.function).shared_bytes);
  if (load_kernel(launch.function) != cudaSuccess) return;
  if (launch.blocks == 0 || launch.shared_bytes > allowed) {
    fail(cudaErrorInvalidValue);
    return;
  }
  ++launches_so_far;
  append(stream, {"kernel", [launch, lane = std::move(lane)] { run_grid(launch, lane); }, nullptr});
}

}  // namespace emulated

using namespace emulated;

cudaError_t cudaGetLastError() {
  const std::scoped_lock held(lock());
  return std::exchange(last_error, cudaSuccess);
}

const char* cudaGetErrorString(cudaError_t error) {
  static thread_local char text[40];
  std::snprintf(text, sizeof text, "emulated error %d", int(error));
  return text;
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags) {
  const std::scoped_lock held(lock());
  if (flags != cudaStreamNonBlocking) broken("a stream that waits for the default stream");
  streams.push_back(*stream = new Stream);
  return cudaSuccess;
}

cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  const std::scoped_lock held(lock());
  stream->run_all();
  std::erase(streams, stream);
  delete stream;
  return cudaSuccess;
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  const std::scoped_lock held(lock());
  if (this_thread_captures()) return fail(cudaErrorStreamCaptureUnsupported);
  if (!stream) broken("a wait for the default stream");
  stream->run_all();
  return cudaSuccess;
}

cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode mode) {
  const std::scoped_lock held(lock());
  if (mode != cudaStreamCaptureModeThreadLocal) broken("a capture that forbids other threads their work");
  if (!stream || stream->captured || captured_here || !stream->queue.empty()) return fail(cudaErrorInvalidValue);
  stream->captured = new Graph;
  stream->capturing_thread = std::this_thread::get_id();
  stream->capture_broken = captures_to_break > 0;
  captures_to_break -= stream->capture_broken;
  captured_here = stream;
  return cudaSuccess;
}

cudaError_t cudaThreadExchangeStreamCaptureMode(cudaStreamCaptureMode* mode) {
  std::swap(*mode, mode_here);
  return cudaSuccess;
}

cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t* graph) {
  const std::scoped_lock held(lock());
  *graph = nullptr;
  if (!stream->captured) return fail(cudaErrorInvalidValue);
  captured_here = nullptr;
  Graph* captured = std::exchange(stream->captured, nullptr);
  if (stream->capture_broken) {
    delete captured;
    return fail(cudaErrorStreamCaptureInvalidated);
  }
  *graph = captured;
  return cudaSuccess;
}

cudaError_t cudaGraphDestroy(cudaGraph_t graph) {
  delete graph;
  return cudaSuccess;
}

cudaError_t cudaGraphInstantiate(cudaGraphExec_t* executable, cudaGraph_t graph, unsigned long long) {
  *executable = new Graph(*graph);
  return cudaSuccess;
}

cudaError_t cudaGraphExecUpdate(cudaGraphExec_t executable, cudaGraph_t graph, cudaGraphExecUpdateResultInfo*) {
  const std::scoped_lock held(lock());
  const auto alike = [](const Node& a, const Node& b) { return a.kind == b.kind; };
  if (!std::equal(executable->nodes.begin(), executable->nodes.end(), graph->nodes.begin(), graph->nodes.end(), alike))
    return fail(cudaErrorGraphExecUpdateFailure);
  *executable = *graph;
  return cudaSuccess;
}

cudaError_t cudaGraphLaunch(cudaGraphExec_t executable, cudaStream_t stream) {
  for (const Node& node : executable->nodes)
    if (const cudaError_t status = append(stream, node); status != cudaSuccess) return status;
  return cudaSuccess;
}

cudaError_t cudaGraphExecDestroy(cudaGraphExec_t executable) {
  const std::scoped_lock held(lock());
  for (const Stream* stream : streams)
    if (!stream->queue.empty()) broken("a graph is destroyed that may still run");
  delete executable;
  return cudaSuccess;
}

cudaError_t cudaEventCreate(cudaEvent_t* event) {
  *event = new Event;
  return cudaSuccess;
}

cudaError_t cudaEventDestroy(cudaEvent_t event) {
  const std::scoped_lock held(lock());
  if (event->pending > 0) broken("an event is destroyed that is still to be recorded");
  delete event;
  return cudaSuccess;
}

cudaError_t cudaEventQuery(cudaEvent_t event) {
  const std::scoped_lock held(lock());
  if (this_thread_captures()) return fail(cudaErrorStreamCaptureUnsupported);
  return event->pending > 0 ? fail(cudaErrorNotReady) : cudaSuccess;
}

cudaError_t cudaEventSynchronize(cudaEvent_t event) {
  const std::scoped_lock held(lock());
  if (this_thread_captures()) return fail(cudaErrorStreamCaptureUnsupported);
  if (event->pending > 0) run_all_streams();
  return cudaSuccess;
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  return cudaEventRecordWithFlags(event, stream, cudaEventRecordDefault);
}

cudaError_t cudaEventRecordWithFlags(cudaEvent_t event, cudaStream_t stream, unsigned flags) {
  const bool captured = stream && stream->captured;
  if (captured && flags != cudaEventRecordExternal) broken("an event of a capture that has no time");
  if (!captured && flags == cudaEventRecordExternal) return fail(cudaErrorInvalidValue);
  const auto record = [event] {
    event->recorded = true;
    event->time = now();
  };
  return append(stream, {"event", record, event});
}

cudaError_t cudaEventElapsedTime(float* milliseconds, cudaEvent_t begin, cudaEvent_t end) {
  const std::scoped_lock held(lock());
  if (begin->pending > 0 || end->pending > 0) return fail(cudaErrorNotReady);
  if (!begin->recorded || !end->recorded) return fail(cudaErrorInvalidValue);
  constexpr float shortest = 1e-4f;  // a stage has some time, however coarse the clock is
  *milliseconds = float((end->time - begin->time) * 1e3) + shortest;
  return cudaSuccess;
}
