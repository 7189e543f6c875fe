// Nacre: fuzz target: values of options that are more than a number: ranges, materials, names of vectors.
#include "engine/io/array_families.hpp"
#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/settings/settings.hpp"
#include "engine/scene/volume/material_options.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nacre::fuzz::read_as_text(data, size, [](const std::string& text) {
    const std::string value = text.empty() ? text : text.substr(1);
    nacre::Settings settings;
    switch (text.empty() ? 0 : static_cast<unsigned char>(text[0]) % 8) {
      case 0: nacre::parse_pair(value, 'x', "--size"); break;
      case 1:
        settings.time = value;
        nacre::parse_time_range(settings);
        break;
      case 2:
        settings.color_range = value;
        nacre::check_color_range(settings);
        nacre::color_range(settings, {0, 1, 0.1, false, {0, 0.5f, 1}});
        break;
      case 3:
        settings.materials.isovalue = value;
        nacre::parse_material_settings(settings.materials);
        break;
      case 4:
        settings.materials.materials = value;
        nacre::parse_material_settings(settings.materials);
        break;
      case 5:
        settings.materials.merge = value;
        nacre::parse_material_settings(settings.materials);
        break;
      default: {
        nacre::NumberedName name;
        nacre::split_numbered_name(value, name);
      }
    }
  });
  return 0;
}
