// Nacre: `nacre sample`: the built-in data sets, listed or written to a file.
#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/common.hpp"
#include "compute/device/error.hpp"
#include "engine/io/nrrd_writer.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/scene/phantoms.hpp"
#include "engine/scene/samples.hpp"

namespace nacre {
namespace {

void list_samples() {
  fmt::print("surfaces with a flow, for nacre flow:\n");
  for (const SampleInfo& sample : samples()) fmt::print("{:<16} {}\n", sample.name, sample.help);
  fmt::print("\nvolumes, for nacre mesh:\n");
  for (const PhantomInfo& phantom : phantoms())
    fmt::print("{:<16} {} ({} x {} x {})\n", phantom.name, phantom.help, phantom.dims.x, phantom.dims.y,
               phantom.dims.z);
}

void write_surface_sample(const std::string& name, int detail, const std::filesystem::path& out) {
  const SurfaceSeries series = checked_words([&] { return make_sample(name, detail); });
  if (out.extension() == ".pvd") {
    const auto files = write_series(out, series);
    fmt::print("{} ({} steps)\n", out.string(), files.size() - 1);
  } else {
    write_surface(out, series.load(0), series.times[0]);
    fmt::print("{}\n", out.string());
  }
}

}  // namespace

void add_sample_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("sample", "list the built-in data sets, or write one to a file");
  struct Words {
    std::string name, out;
    int detail = 0;
  };
  auto words = std::make_shared<Words>();
  command->add_option("NAME", words->name, "which one");
  command->add_option("--out", words->out,
                      "a surface: .pvd (all time steps), or .vtp .ply .obj .stl .off (the first); a volume: .nrrd");
  command
      ->add_option("--detail", words->detail, "triangle edges, or voxels, along the longest side (0: the sample's own)")
      ->check(CLI::Range(0, 1 << 20));
  command->callback([&run, words] {
    run = [words] {
      if (words->name.empty()) return list_samples();
      if (words->out.empty()) throw UsageError("where to? add --out FILE");
      if (!is_phantom(words->name)) return write_surface_sample(words->name, words->detail, words->out);
      write_nrrd(words->out,
                 checked_words([&] { return make_phantom(words->name, words->detail, &interrupt_flag()); }));
      fmt::print("{}\n", words->out);
    };
  });
}

}  // namespace nacre
