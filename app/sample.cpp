// Nacre: `nacre sample`: the built-in data sets, listed or written to a file.
#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/common.hpp"
#include "compute/device/error.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/scene/samples.hpp"

namespace nacre {

void add_sample_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("sample", "list the built-in data sets, or write one to a file");
  struct Words {
    std::string name, out;
    int detail = 0;
  };
  auto words = std::make_shared<Words>();
  command->add_option("NAME", words->name, "which one");
  command->add_option("--out", words->out, ".pvd (all time steps), or .vtp .ply .obj .stl .off (the first)");
  command->add_option("--detail", words->detail, "triangle edges along the longest side (0: the sample's own)")
      ->check(CLI::NonNegativeNumber);
  command->callback([&run, words] {
    run = [words] {
      if (words->name.empty()) {
        for (const SampleInfo& sample : samples()) fmt::print("{:<16} {}\n", sample.name, sample.help);
        return;
      }
      if (words->out.empty()) throw UsageError("where to? add --out FILE");
      const SurfaceSeries series = checked_words([&] { return make_sample(words->name, words->detail); });
      const std::filesystem::path out = words->out;
      if (out.extension() == ".pvd") {
        const auto files = write_series(out, series);
        fmt::print("{} ({} steps)\n", out.string(), files.size() - 1);
      } else {
        write_surface(out, series.load(0), series.times[0]);
        fmt::print("{}\n", out.string());
      }
    };
  });
}

}  // namespace nacre
