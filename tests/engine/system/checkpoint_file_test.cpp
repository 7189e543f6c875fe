// Nacre: tests of files that a run can go on from.
#include "engine/system/checkpoint_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

using test::read_all;
using test::TemporaryFolder;

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

void write_checkpoint(const std::filesystem::path& file, const std::string& text, const std::string& state) {
  CheckpointWriter writer(file, text);
  writer.put(bytes_of(state));
  writer.commit();
}

void write_all(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

/// What an attempt to read all of it throws; empty: nothing.
std::string complaint_about(const std::filesystem::path& file, std::size_t state_bytes) {
  try {
    CheckpointReader reader(file);
    std::vector<std::byte> state(state_bytes);
    reader.take(state);
    reader.finish();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(CheckpointFile, GivesBackWhatWasPut) {
  const TemporaryFolder folder;
  CheckpointWriter writer(folder / "a", "{\"step\": 3}");
  writer.put(bytes_of("values"));
  writer.put({});
  writer.put(bytes_of(std::string(3 << 20, 'x')));
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
  writer.commit();
  CheckpointReader reader(folder / "a");
  EXPECT_EQ(reader.text(), "{\"step\": 3}");
  std::string first(3, ' '), rest(3 + (3 << 20), ' ');
  reader.take(std::as_writable_bytes(std::span(first)));
  reader.take(std::as_writable_bytes(std::span(rest)));
  reader.finish();
  EXPECT_EQ(first + rest.substr(0, 3), "values");
  EXPECT_EQ(rest.substr(3), std::string(3 << 20, 'x'));
}

TEST(CheckpointFile, AnyOtherByteAndAnyOtherLengthIsNoticed) {
  const TemporaryFolder folder;
  write_checkpoint(folder / "whole", "which run", "state");
  const std::string whole = read_all(folder / "whole");
  ASSERT_EQ(complaint_about(folder / "whole", 5), "");
  for (std::size_t k = 0; k < whole.size(); ++k) {
    std::string other = whole;
    other[k] = char(other[k] ^ 4);
    write_all(folder / "other", other);
    EXPECT_NE(complaint_about(folder / "other", 5), "") << "byte " << k;
    write_all(folder / "short", whole.substr(0, k));
    EXPECT_NE(complaint_about(folder / "short", 5), "") << "the first " << k << " bytes";
  }
  write_all(folder / "long", whole + "x");
  EXPECT_NE(complaint_about(folder / "long", 5), "");
  EXPECT_NE(complaint_about(folder / "whole", 4).find("more than"), std::string::npos);
  EXPECT_NE(complaint_about(folder / "whole", 6).find("too early"), std::string::npos);
  EXPECT_NE(complaint_about(folder / "none", 5).find("none"), std::string::npos);
}

TEST(CheckpointFile, TheOlderOneStaysUntilTheNextIsComplete) {
  const TemporaryFolder folder;
  write_checkpoint(folder / "a", "first", "state");
  {
    CheckpointWriter next(folder / "a", "second");
    next.put(bytes_of("more"));
  }
  EXPECT_EQ(CheckpointReader(folder / "a").text(), "first");
  EXPECT_EQ(folder.entries(), 1u) << "nothing else is left";
  write_checkpoint(folder / "a", "second", "state");
  EXPECT_EQ(CheckpointReader(folder / "a").text(), "second");
}

}  // namespace
}  // namespace nacre
