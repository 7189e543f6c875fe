// Nacre: what the commands that compute share.
#include "app/run.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include "engine/scene/settings/ranges.hpp"
#include "engine/system/extension.hpp"

namespace nacre {

void add_input_options(CLI::App& command, InputOptions& input, const std::string& file_help,
                       const std::string& detail_help) {
  command.add_option("FILE", input.files, file_help);
  command.add_option("--sample", input.sample, "a built-in data set; `nacre sample` lists them");
  command.add_option("--detail", input.detail, detail_help)->check(CLI::Range(0, 1 << 20));
  command.add_option("--size", input.size, "size of the picture in pixels, WxH");
}

Session requested_session(const CommonOptions& options, const InputOptions& input, const KnobOptions& knobs,
                          std::string_view command, const std::function<void(Settings&)>& preset) {
  Session session;
  if (!options.session.empty()) session = open_session(options.session);
  session.events.clear();  // what is asked for is the state at the start
  session.duration = 0;
  if (!input.files.empty() || !input.sample.empty()) {
    session.inputs.assign(input.files.begin(), input.files.end());
    session.sample = input.sample;
    session.detail = input.detail;
  }
  if (preset) preset(session.settings);
  knobs.apply(session.settings, options.set);
  if (knobs.given("camera", options.set)) session.camera.reset();
  if (!input.size.empty()) {
    const auto [width, height] = with_usage_errors([&] { return parse_pair(input.size, 'x', "--size"); });
    knobs.apply(session.settings, {fmt::format("width={}", width), fmt::format("height={}", height)});
  }
  if (session.inputs.empty() && session.sample.empty())
    throw UsageError(fmt::format("no input: give a FILE or --sample NAME; see nacre {} --help", command));
  if (!session.inputs.empty() && !session.sample.empty()) throw UsageError("give a FILE or --sample, not both");
  return session;
}

std::unique_ptr<Device> open_device(const CommonOptions& options) {
  limit_threads(options.threads);
  std::unique_ptr<Device> device = make_device(options.device, options.threads);
  say(options, fmt::format("device: {} ({}, {} thread{})", device->backend(), device->name(), device->threads(),
                           device->threads() == 1 ? "" : "s"));
  if (!device->remark().empty()) say(options, device->remark());
  if (const std::string why = options.device == "auto" && device->backend() == "cpu" ? why_no_cuda() : ""; !why.empty())
    say(options, "the GPU is not used: " + why);
  return device;
}

void add_beside(Origin& origin, const std::vector<std::pair<std::string, std::string>>& files) {
  for (const auto& [option, file] : files)
    if (!file.empty()) origin.beside[option] = option == "frames" ? "" : lower_extension(file);
}

Origin origin_alone(Origin origin, const std::string& output) {
  origin.output = output;
  // A picture of a flow beside its values is of the whole surface.
  const bool of_pictures = output == "image" || output == "video" || output == "frames";
  if (origin.command == "flow" && of_pictures && origin.beside.contains("out")) origin.knobs["focus"] = "false";
  origin.beside.clear();
  std::erase_if(origin.options, [&](const std::string& option) {
    if (option == "--cut-away") return output != "image";
    if (option == "--per-material" || option == "--surface-only") return output != "out";
    return false;
  });
  return origin;
}

std::string origin_of_output(const Origin& origin, const std::string& output) {
  return origin_text(origin_alone(origin, output));
}

void write_report(const CommonOptions& options, nlohmann::json report, const std::vector<std::string>& outputs,
                  const std::optional<Origin>& origin) {
  if (options.report.empty()) return;
  if (origin) {
    Origin of_report = *origin;
    of_report.output = "report";
    report["origin"] = origin_json(of_report);
  }
  report["outputs"] = outputs;
  write_text(options.report, report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

std::array<std::int64_t, 5> InputWatch::stamp_of(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {};
  return {std::int64_t(status.st_dev), std::int64_t(status.st_ino), status.st_size, status.st_mtim.tv_sec,
          status.st_mtim.tv_nsec};
}

void InputWatch::add(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) stamps_.push_back({file, stamp_of(file)});
}

void InputWatch::check() const {
  for (const Stamp& stamp : stamps_)
    if (stamp_of(stamp.file) != stamp.numbers)
      throw Error(stamp.file.string() + " was changed while it was in use",
                  "the result would be of two different files", "run again when nobody writes it");
}

namespace {
int silent = 0;  // how many PrintNothing there are
}

PrintNothing::PrintNothing() { ++silent; }
PrintNothing::~PrintNothing() { --silent; }

void print_outputs(const std::vector<std::string>& outputs) {
  if (silent > 0) return;
  for (const std::string& file : outputs) fmt::print("{}\n", file);
}

}  // namespace nacre
