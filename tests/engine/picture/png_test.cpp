// Nacre: PNG files come back as they were, and failures leave nothing behind.
#include "engine/picture/png.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "compute/device/error.hpp"
#include "engine/picture/png.hpp"
#include "tests/engine/picture/small_disk.hpp"
#include "tests/engine/picture/temporary_folder.hpp"
#include "tests/engine/picture/test_images.hpp"

namespace nacre {
namespace fs = std::filesystem;
namespace {

/// What the Error says; a failure of the test where there is none.
template <class Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no Error";
  return {};
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

void write_bytes(const fs::path& file, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

TEST(Png, RoundTrip) {
  TemporaryFolder folder;
  for (const bool opaque : {true, false})
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {320, 240}}) {
      const Image image = noise_image(width, height, 3, opaque);
      write_png(folder / "a.png", image);
      const Image back = read_png(folder / "a.png");
      EXPECT_EQ(back.width, width);
      EXPECT_EQ(back.height, height);
      EXPECT_EQ(back.pixels, image.pixels);
    }
  EXPECT_EQ(folder.entries(), 1) << "no temporary file is left";
}

TEST(Png, OpaqueImagesHaveNoAlpha) {
  constexpr int color_type = 25;  // the byte of the header that says RGB (2) or RGBA (6)
  EXPECT_EQ(encode_png(noise_image(4, 4))[color_type], 2);
  EXPECT_EQ(encode_png(noise_image(4, 4, 1, false))[color_type], 6);
}

TEST(Png, FollowsALinkAndKeepsTheUmask) {
  TemporaryFolder folder;
  fs::create_symlink(folder / "real.png", folder / "link.png");
  const mode_t before = umask(027);
  write_png(folder / "link.png", noise_image(4, 4));
  umask(before);
  EXPECT_TRUE(fs::is_symlink(folder / "link.png"));
  EXPECT_EQ(read_png(folder / "real.png").width, 4);
  EXPECT_EQ(fs::status(folder / "real.png").permissions(), fs::perms(0640));
}

TEST(Png, SizesThatTheEncoderCannotCountAreRefused) {
  EXPECT_NO_THROW(check_png_size(16384, 16383));
  EXPECT_TRUE(has(error_of([] { check_png_size(16384, 16384); }), "it may have 268435455 pixels in all"));
}

TEST(Png, UnwritablePlaces) {
  TemporaryFolder folder;
  write_bytes(folder / "file", {1});
  const Image image = noise_image(4, 4);
  EXPECT_TRUE(has(error_of([&] { write_png(folder / "none/a.png", image); }), "none/a.png"));
  EXPECT_TRUE(has(error_of([&] { write_png(folder / "file/a.png", image); }), "Not a directory"));
  EXPECT_TRUE(has(error_of([&] { write_png(folder.path(), image); }), "not a regular file"));
  EXPECT_TRUE(has(error_of([&] { write_png("/dev/null", image); }), "not a regular file"));
  EXPECT_TRUE(has(error_of([&] { write_png("", image); }), "not a regular file"));
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Png, FolderWithoutPermission) {
  TemporaryFolder folder;
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms(0555));
  const bool root = geteuid() == 0;
  if (root) {
    fs::permissions(folder.path(), fs::perms(0755));
    ASSERT_EQ(seteuid(65534), 0);
  }
  const std::string error = error_of([&] { write_png(folder / "locked/a.png", noise_image(4, 4)); });
  if (root) {
    ASSERT_EQ(seteuid(0), 0);
  }
  EXPECT_TRUE(has(error, "locked/a.png (Permission denied)")) << error;
}

TEST(Png, FullDisk) {
  TemporaryFolder folder;
  const SmallDisk disk(folder.path(), 64 << 10);
  if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a small disk";
  write_png(folder / "a.png", noise_image(4, 4));
  const std::string error = error_of([&] { write_png(folder / "a.png", noise_image(300, 300)); });
  EXPECT_TRUE(has(error, "a.png (No space left on device); free some space")) << error;
  EXPECT_EQ(read_png(folder / "a.png").width, 4) << "the earlier picture is still whole";
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Png, LimitOnFileSizes) {
  TemporaryFolder folder;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 4096;
  const auto old_handler = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of([&] { write_png(folder / "a.png", noise_image(100, 100)); });
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, old_handler);
  EXPECT_TRUE(has(error, "a.png (File too large)")) << error;
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace nacre
