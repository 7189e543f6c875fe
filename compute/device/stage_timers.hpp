// Nacre: how long each stage took; the report, the benchmark and the viewer read the same numbers.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
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

  void add(std::string_view name, double seconds, long launches = 0) {
    Stage& stage = find(name);
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

  /// Times its own life.
  class Scope {
   public:
    Scope(StageTimers& timers, std::string_view name)
        : timers_(timers), name_(name), launches_(timers.launches_), start_(std::chrono::steady_clock::now()) {}
    ~Scope() {
      timers_.add(name_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(),
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
  Stage& find(std::string_view name) {
    for (Stage& stage : stages_)
      if (stage.name == name) return stage;
    return stages_.emplace_back(Stage{std::string(name)});
  }

  std::vector<Stage> stages_;
  long launches_ = 0;
};

}  // namespace nacre
