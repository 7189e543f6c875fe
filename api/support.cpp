// Nacre: what all parts of the public library share.
#include "api/support.hpp"

#include <fmt/format.h>
#include <tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <regex>

#include "engine/scene/settings/edit_distance.hpp"
#include "include/nacre/device.hpp"

namespace nacre {
namespace {

const char* command_of(Job job) { return job == Job::mesh ? "mesh" : "flow"; }

/// Knobs that belong to a command line; library users set these in other ways.
bool is_offered(const Knob& knob, Job job) {
  if (!knob.concerns(command_of(job))) return false;
  if (job == Job::mesh)
    return knob.group != "picture" && knob.name != "names" && knob.name != "layer" && knob.name != "size_image";
  return knob.name != "vectors" && knob.name != "patch" && knob.name != "fps" && knob.name != "focus" &&
         knob.name != "ftle_time" && knob.name != "tracks" && knob.name != "probe" && !knob.name.starts_with("dye");
}

KnobValue value_of(const Knob& knob) {
  if (const auto* p = std::get_if<int*>(&knob.value)) return std::int64_t(**p);
  if (const auto* p = std::get_if<std::uint32_t*>(&knob.value)) return std::int64_t(**p);
  if (const auto* p = std::get_if<double*>(&knob.value)) return **p;
  if (const auto* p = std::get_if<bool*>(&knob.value)) return **p;
  return knob.text();
}

const char* type_name(const Knob& knob) {
  if (std::holds_alternative<bool*>(knob.value)) return "true or false";
  if (std::holds_alternative<double*>(knob.value)) return "a number";
  if (std::holds_alternative<int*>(knob.value) || std::holds_alternative<std::uint32_t*>(knob.value))
    return "a whole number";
  return "a text";
}

bool fits(const Knob& knob, const KnobValue& value) {
  const bool text = std::holds_alternative<std::string>(value), on_off = std::holds_alternative<bool>(value);
  if (std::holds_alternative<bool*>(knob.value)) return on_off;
  if (std::holds_alternative<double*>(knob.value)) return !text && !on_off;
  if (std::holds_alternative<int*>(knob.value) || std::holds_alternative<std::uint32_t*>(knob.value))
    return std::holds_alternative<std::int64_t>(value);
  return text;
}

std::string text_of(const KnobValue& value) {
  return std::visit([](const auto& stored) { return fmt::format("{}", stored); }, value);
}

const Knob& find_knob(const std::vector<Knob>& table, const std::string& name, Job job) {
  const Knob* nearest = nullptr;
  std::size_t least = ~std::size_t(0);
  for (const Knob& knob : table) {
    if (!is_offered(knob, job)) continue;
    if (knob.is_named(name)) return knob;
    const auto distance = std::size_t(edit_distance(knob.name, name));
    if (distance < least) least = distance, nearest = &knob;
  }
  throw Error(fmt::format("no knob '{}'", name), "", fmt::format("did you mean {}?", nearest->name));
}

/// What may change while a run goes on.
bool is_live(const Knob& knob, Job job) {
  if (job == Job::mesh) return knob.group != "materials";
  return knob.name != "time" && knob.name != "begin_at" && knob.name != "steps" && knob.name != "crease_angle";
}

std::atomic<pid_t> computed_in{0};

}  // namespace

std::string with_knob_names(const std::string& text) {
  static const std::regex option("(^|[^-\\w])--(no-)?([a-z][a-z0-9-]*)"), quoted("`([a-z][a-z0-9_]*)`");
  std::string result;
  auto at = text.cbegin();
  for (std::sregex_iterator match(text.cbegin(), text.cend(), option), end; match != end; ++match) {
    std::string name = (*match)[3];
    std::replace(name.begin(), name.end(), '-', '_');
    result.append(at, (*match)[0].first);
    result += (*match)[1].str() + name;
    at = (*match)[0].second;
  }
  result.append(at, text.cend());
  return std::regex_replace(result, quoted, "$1");
}

void apply_knobs(Settings& settings, const KnobValues& knob_values, Job job) {
  const std::vector<Knob> table = knobs(settings);
  for (const auto& [name, value] : knob_values) {
    const Knob& knob = find_knob(table, name, job);
    if (!fits(knob, value))
      throw Error(fmt::format("{} takes {}, not '{}'", knob.name, type_name(knob), text_of(value)));
    set_knob(settings, knob.name, text_of(value));
  }
}

KnobValue knob_value(const Settings& settings, const std::string& name, Job job) {
  Settings copy = settings;
  const std::vector<Knob> table = knobs(copy);
  return value_of(find_knob(table, name, job));
}

std::vector<KnobDescription> describe_knobs(Job job) {
  Settings defaults;
  std::vector<KnobDescription> result;
  for (const Knob& knob : knobs(defaults))
    if (is_offered(knob, job))
      result.push_back({knob.name, with_knob_names(knob.help), knob.unit, knob.group, value_of(knob), knob.min,
                        knob.max, knob.choices, is_live(knob, job)});
  return result;
}

void check_process() {
  pid_t none = 0;
  const pid_t here = getpid();
  if (!computed_in.compare_exchange_strong(none, here) && none != here)
    throw Error("Nacre cannot compute in a process that was forked from one in which it had computed",
                "worker threads are not copied by fork",
                "start fresh processes: in Python, multiprocessing.get_context(\"spawn\")");
}

std::unique_ptr<Device> open_library_device(const RunOptions& options) {
  if (options.threads < 0) throw Error(fmt::format("{} threads were asked for", options.threads), "", "use 0 for all");
  const bool gpu_number = std::regex_match(options.device, std::regex("cuda:[0-9]{1,4}"));
  if (options.device != "auto" && options.device != "cpu" && options.device != "cuda" && !gpu_number)
    throw Error(fmt::format("no device '{}'", options.device), "", "use auto, cpu, cuda or cuda:N");
  check_process();
  return make_device(options.device, std::min(options.threads, tbb::info::default_concurrency()));
}

std::vector<DeviceDescription> devices() {
  check_process();
  std::vector<DeviceDescription> result{{"cpu", "cpu", make_cpu_device()->name()}};
  for (int k = 0; k < cuda_device_count(); ++k) {
    const std::string request = fmt::format("cuda:{}", k);
    result.push_back({request, "cuda", make_cuda_device(1 << 20, k)->name()});
  }
  return result;
}

std::string why_no_gpu() { return why_no_cuda(); }

Caller::Caller(std::mutex& mutex, int threads) : lock_(mutex, std::try_to_lock) {
  if (!lock_)
    throw Error("this run is busy", "another thread, or a callback of its own, uses it", "give each thread its own");
  check_process();
  if (threads > 0)
    limit_ = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
}

}  // namespace nacre
