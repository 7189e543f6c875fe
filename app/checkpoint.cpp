// Nacre: `nacre flow --checkpoint`.
#include "app/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "app/ranks.hpp"
#include "compute/device/error.hpp"
#include "engine/run/among_ranks.hpp"
#include "engine/system/faults.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using KnobTexts = std::map<std::string, std::string>;

std::string knob_difference(const KnobTexts& then, const KnobTexts& now) {
  std::set<std::string> names;
  for (const auto* knobs : {&then, &now})
    for (const auto& [name, text] : *knobs) names.insert(name);
  const auto text_in = [](const KnobTexts& knobs, const std::string& name) {
    const auto found = knobs.find(name);
    return found == knobs.end() ? "the default" : found->second.empty() ? "empty" : found->second;
  };
  for (const std::string& name : names)
    if (text_in(then, name) != text_in(now, name))
      return fmt::format("`{}` was {} and is {}", name, text_in(then, name), text_in(now, name));
  return "";
}

/// Files count by what is in them, not by their names.
std::string file_difference(const json& then, const json& now) {
  if (then.size() != now.size()) return fmt::format("it had {} input files, and these are {}", then.size(), now.size());
  for (std::size_t k = 0; k < then.size(); ++k)
    if (then[k].at("sha256") != now[k].at("sha256"))
      return now[k].at("file").get<std::string>() + " is not the file that it read";
  return "";
}

/// In what two runs differ (as origin_json describes them), in words; empty: in nothing that counts.
std::string difference(const json& then, const json& now) {
  const auto text = [](const json& from, const char* key) { return from.value(key, std::string()); };
  if (text(then, "version") != text(now, "version"))
    return fmt::format("version {} made it, and this is {}", text(then, "version"), text(now, "version"));
  if (text(then, "backend") != text(now, "backend"))
    return fmt::format("it ran on {}, and this is {}", text(then, "backend"), text(now, "backend"));
  const json none = json::array();
  for (const char* files : {"inputs", "others"})
    if (std::string why = file_difference(then.value(files, none), now.value(files, none)); !why.empty()) return why;
  if (text(then, "sample") != text(now, "sample"))
    return fmt::format("its sample was '{}' and is '{}'", text(then, "sample"), text(now, "sample"));
  if (then.value("detail", 0) != now.value("detail", 0))
    return fmt::format("--detail was {} and is {}", then.value("detail", 0), now.value("detail", 0));
  if (std::string why = knob_difference(then.at("knobs").get<KnobTexts>(), now.at("knobs").get<KnobTexts>());
      !why.empty())
    return why;
  if (then.value("camera", json()) != now.value("camera", json())) return "the camera is another one";
  if (then.value("options", none) != now.value("options", none)) return "--chunk or --lead-in is another one";
  if (then.value("beside", json()) != now.value("beside", json())) return "it wrote other kinds of results";
  return "";
}

}  // namespace

Checkpoint::Checkpoint(const FlowOptions& options, Ranks* ranks) : options_(options), ranks_(ranks) {
  if (!wanted()) return;
  std::error_code ignored;
  if (is_first_process() && std::filesystem::exists(options.checkpoint, ignored)) file_.emplace(options.checkpoint);
  const std::string text = first_ones(ranks, file_ ? file_->text() : std::string());
  if (text.empty()) return;
  found_ = json::parse(text);  // the checksum was right
  continues_ = true;
}

FrameRange Checkpoint::steps_left(const FrameRange& steps) const {
  return {continues_ ? std::max(steps.first, found_.at("next_step").get<int>()) : steps.first, steps.last};
}

void Checkpoint::require_same(const Origin& origin) {
  if (!wanted()) return;
  run_ = origin_json(origin);
  if (!continues_) return;
  if (const std::string why = difference(found_.at("run"), run_); !why.empty())
    throw Error(options_.checkpoint + " is the checkpoint of another run", why,
                "give the command of that run, or remove the file");
}

std::size_t Checkpoint::available(std::size_t now) {
  available_ = continues_ ? found_.at("available").get<std::size_t>() : now;
  return available_;
}

void Checkpoint::start(FlowPipeline& pipeline, FlowMotion& motion, const FlowVectors& vectors) {
  if (!wanted()) {
    motion.start(vectors);
    return;
  }
  pipeline_ = &pipeline;
  motion_ = &motion;
  last_write_ = now();
  held_.emplace();
  const auto between = [this] { after_step(); };
  if (!continues_) {
    motion.start(vectors, between);
    return;
  }
  const int next = found_.at("next_step").get<int>();
  say(options_.common, fmt::format("going on before step {}, from {}", next, options_.checkpoint));
  motion.go_on(
      vectors, found_.at("base").get<double>(), found_.at("rebuilds").get<int>(), next,
      [this](std::span<std::byte> bytes) { file_->take(bytes); }, between);
  if (file_) file_->finish();
  file_.reset();
}

void Checkpoint::after_step() {
  if (!held_) return;
  const bool due = now() - last_write_ >= 60 * options_.checkpoint_every;
  std::uint64_t stop_or_due[] = {HeldInterrupts::asked() || fault_due("stop"), is_first_process() && due};
  if (ranks_) ranks_->sum(stop_or_due);
  if (stop_or_due[0] || stop_or_due[1]) write();
  if (!stop_or_due[0]) return;
  held_.reset();
  throw Interrupted();
}

/// A failure ends nothing: the older file is there, and what the run has made is worth more.
void Checkpoint::write() {
  const double begun = now();
  const json state = {{"run", run_},
                      {"next_step", pipeline_->flow().next_step()},
                      {"available", available_},
                      {"base", motion_->base()},
                      {"rebuilds", motion_->rebuilds()}};
  std::optional<CheckpointWriter> file;
  std::string failure;
  const auto attempt = [&](const auto& action) {
    if (failure.empty() && is_first_process()) try {
        action();
      } catch (const Error& error) {
        failure = error.what();
      }
  };
  attempt([&] { file.emplace(options_.checkpoint, state.dump(-1, ' ', false, json::error_handler_t::replace)); });
  pipeline_->flow().save([&](std::span<const std::byte> bytes) { attempt([&] { file->put(bytes); }); });
  attempt([&] { file->commit(); });
  if (!failure.empty()) warn_of_result(failure + "; an older checkpoint is kept");
  std::uint64_t all_wait = 0;  // for the file, before one of them may end them all
  if (ranks_) ranks_->sum({&all_wait, 1});
  writes_ += failure.empty();
  last_write_ = now();
  write_seconds_ += last_write_ - begun;
}

void Checkpoint::remove() {
  std::error_code ignored;
  if (wanted() && is_first_process()) std::filesystem::remove(options_.checkpoint, ignored);
}

json Checkpoint::report() const {
  json report = {{"written", writes_}, {"seconds", write_seconds_}};
  if (continues_) report["continued_before_step"] = found_.at("next_step");
  return report;
}

}  // namespace nacre
