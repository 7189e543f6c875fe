// Nacre: how long each stage took; the report, the benchmark and the viewer read the same numbers.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nacre {

/// Wall time, number of calls and of launches per named stage, in the order in which the stages first ran.
class StageTimers {
 public:
  struct Stage {
    std::string name;
    double seconds = 0;
    long calls = 0;
    long launches = 0;  ///< of an Executor, within its calls
  };

  void add(std::string name, double seconds, long launches = 0) {
    Stage& stage = find(std::move(name));
    stage.seconds += seconds;
    stage.launches += launches;
    ++stage.calls;
  }

  void count_launch() { ++launches_; }
  long launches() const { return launches_; }  ///< of all stages so far

  const std::vector<Stage>& stages() const { return stages_; }

  double seconds(std::string_view name) const {
    for (const Stage& stage : stages_)
      if (stage.name == name) return stage.seconds;
    return 0;
  }

  /// Times its own life. Its end asks for no memory: it may be why the stage ends.
  class Scope {
   public:
    Scope(StageTimers& timers, std::string_view name)
        : timers_(timers), name_(name), launches_(timers.launches_), start_(std::chrono::steady_clock::now()) {
      timers.stages_.reserve(timers.stages_.size() + timers.open_ + 1);
      ++timers.open_;
    }
    ~Scope() {
      --timers_.open_;
      timers_.add(std::move(name_), std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(),
                  timers_.launches_ - launches_);
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StageTimers& timers_;
    std::string name_;
    long launches_;
    std::chrono::steady_clock::time_point start_;
  };

 private:
  Stage& find(std::string name) {
    for (Stage& stage : stages_)
      if (stage.name == name) return stage;
    return stages_.emplace_back(Stage{std::move(name)});
  }

  std::vector<Stage> stages_;
  std::size_t open_ = 0;  // scopes
  long launches_ = 0;
};

}  // namespace nacre
