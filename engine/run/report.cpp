// Nacre: what every report begins with.
#include "engine/run/report.hpp"

#include <memory>

#include "include/nacre/version.hpp"

namespace nacre {

nlohmann::json stages_report(const StageTimers& timers) {
  auto report = nlohmann::json::array();
  for (const StageTimers::Stage& stage : timers.stages())
    report.push_back(
        {{"name", stage.name}, {"seconds", stage.seconds}, {"calls", stage.calls}, {"launches", stage.launches}});
  return report;
}

nlohmann::json report_frame(const std::string& command, const Device& device, const StageTimers& timers,
                            std::size_t arena_bytes) {
  // An object from the start: nlohmann json 3.11.2 crashes if memory runs out while a null value becomes one.
  nlohmann::json report = nlohmann::json::object();
  report["nacre"] = NACRE_VERSION_STRING;
  report["command"] = command;
  report["device"] = {{"backend", device.backend()}, {"name", device.name()}, {"threads", device.threads()}};
  report["stages"] = stages_report(timers);
  std::unique_ptr<Device> host = device.backend() == "cpu" ? nullptr : make_cpu_device();
  report["memory"] = {{"peak_bytes", host ? host->peak_bytes() : device.peak_bytes()},
                      {"device_peak_bytes", arena_bytes}};
  return report;
}

}  // namespace nacre
