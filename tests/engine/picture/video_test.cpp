// Nacre: frame folders and videos, whole or not at all.
#include "engine/picture/video.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "engine/picture/png.hpp"
#include "engine/system/child_process.hpp"
#include "tests/engine/picture/small_disk.hpp"
#include "tests/engine/picture/temporary_folder.hpp"
#include "tests/engine/picture/test_images.hpp"

namespace nacre {
namespace fs = std::filesystem;
namespace {

using Arguments = std::vector<std::string>;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string output_of(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return {};
  std::string text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += char(c);
  pclose(pipe);
  return text;
}

/// "width,height,frames" of a video, as ffprobe counts them.
std::string probe(const fs::path& file) {
  const std::string text = output_of(
      "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
      "stream=width,height,nb_read_frames -of csv=p=0 '" +
      file.string() + "'");
  return text.substr(0, text.find('\n'));
}

/// PATH with one folder only, put back at the end.
class OnlyPath {
 public:
  explicit OnlyPath(const fs::path& folder) : before_(std::getenv("PATH") ? std::getenv("PATH") : "") {
    setenv("PATH", folder.c_str(), 1);
  }
  ~OnlyPath() { setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

void write_program(const fs::path& file, const std::string& script) {
  std::ofstream(file) << "#!/bin/sh\n" << script;
  fs::permissions(file, fs::perms(0755));
}

/// What a video of `frames` noise frames fails with; empty where it does not.
std::string failure_of_video(const fs::path& file, int frames, int size) {
  try {
    const auto video = make_video(file, 25);
    for (int i = 0; i < frames; ++i) video->add(noise_image(size, size, unsigned(i + 1)));
    video->finish();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(FrameFolder, WritesNumberedPicturesAndOverwritesOldOnes) {
  TemporaryFolder folder;
  for (const unsigned seed : {1u, 2u}) {
    const auto frames = make_frame_folder(folder / "deep/run");
    for (unsigned i = 0; i < 3; ++i) frames->add(noise_image(8, 6, seed + 10 * i));
    frames->finish();
  }
  EXPECT_EQ(read_png(folder / "deep/run/frame_0002.png").pixels, noise_image(8, 6, 22).pixels);
  EXPECT_FALSE(fs::exists(folder / "deep/run/frame_0003.png"));
}

TEST(FrameFolder, FramesOfAnEarlierLongerRunGoWithTheFirstNewOne) {
  TemporaryFolder folder;
  const Arguments others = {"frame_3.png", "frame_00003.png", "frame_-001.png", "my_frame_0003.png", "frame_0003.jpg"};
  for (const std::string& name : others) std::ofstream(folder / name) << "mine";
  fs::create_directory(folder / "frame_0009.png");
  for (int k = 0; k < 6; ++k) std::ofstream(folder / ("frame_000" + std::to_string(k) + ".png")) << "old";
  std::ofstream(folder / "frame_12345.png") << "old";
  Arguments said;
  const auto frames = make_frame_folder(folder.path(), [&](const std::string& line) { said.push_back(line); });
  EXPECT_EQ(folder.entries(), 13) << "a run that fails before its first frame takes none away";
  for (unsigned i = 0; i < 2; ++i) frames->add(noise_image(8, 6, i + 1));
  EXPECT_EQ(said, Arguments{"removed 7 frames of an earlier run from " + folder.path().string()});
  EXPECT_EQ(folder.entries(), 8);
  EXPECT_EQ(read_png(folder / "frame_0001.png").width, 8);
  for (const std::string& name : others) EXPECT_EQ(content(folder / name), "mine") << name;
}

TEST(FrameFolder, NamesWhatIsWrong) {
  TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW(make_frame_folder(folder / "file"), Error);
  EXPECT_THROW(make_frame_folder(folder / "file/below"), Error);
  EXPECT_THROW(make_frame_folder(folder / "empty")->finish(), Error);
  EXPECT_FALSE(fs::exists(folder / "empty"));
}

TEST(FrameFolder, FullDiskLeavesWholeFramesOnly) {
  TemporaryFolder folder;
  const SmallDisk disk(folder.path(), 256 << 10);
  if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a small disk";
  const auto frames = make_frame_folder(folder.path());
  EXPECT_THROW(for (unsigned i = 0; i < 20; ++i) frames->add(noise_image(150, 150, i + 1)), Error);
  EXPECT_GT(folder.entries(), 1);
  for (const auto& entry : fs::directory_iterator(folder.path())) EXPECT_EQ(read_png(entry.path()).width, 150);
}

TEST(Video, SizesThatFfmpegRefusesAreKnownBefore) {
  EXPECT_NO_THROW(check_video_size(16384, 16000));
  EXPECT_THROW(check_video_size(16384, 16384), Error);  // "Picture size 16384x16384 is invalid", of ffmpeg 5.1
}

class VideoTest : public testing::Test {
 protected:
  void SetUp() override {
    if (find_program("ffmpeg").empty() || find_program("ffprobe").empty()) GTEST_SKIP() << "ffmpeg is not installed";
  }
  TemporaryFolder folder;
};

TEST_F(VideoTest, HasEveryFrameAndAnEvenSize) {
  for (const auto& [width, height, expected] :
       {std::tuple{64, 48, "64,48,12"}, {63, 47, "64,48,12"}, {1, 1, "2,2,12"}}) {
    const auto video = make_video(folder / "a b:c'.mp4", 25);
    for (unsigned i = 0; i < 12; ++i) video->add(noise_image(width, height, i + 1));
    EXPECT_FALSE(fs::exists(folder / "a b:c'.mp4")) << "not before it is whole";
    video->finish();
    fs::rename(folder / "a b:c'.mp4", folder / "plain.mp4");
    EXPECT_EQ(probe(folder / "plain.mp4"), expected);
    EXPECT_EQ(folder.entries(), 1);
  }
}

TEST_F(VideoTest, AFrameOfAnotherSizeIsBroughtToThatOfTheFirst) {
  const auto video = make_video(folder / "a.mp4", 25), pictures = make_frame_folder(folder / "frames");
  for (const auto& [width, height] : {std::pair{64, 48}, {300, 20}, {16, 90}, {64, 48}})
    for (FrameSink* sink : {video.get(), pictures.get()}) sink->add(noise_image(width, height, 7));
  video->finish();
  EXPECT_EQ(probe(folder / "a.mp4"), "64,48,4");
  const Image third = read_png(folder / "frames/frame_0002.png");
  EXPECT_EQ(third.width, 64);
  EXPECT_EQ(third.height, 48);
}

TEST_F(VideoTest, OtherContainers) {
  for (const char* name : {"a.mkv", "a.mov", "a.webm", "a.gif", "A.MP4"}) {
    EXPECT_EQ(failure_of_video(folder / name, 3, 64), "") << name;
    EXPECT_EQ(probe(folder / name), "64,64,3") << name;
  }
}

TEST_F(VideoTest, CanBePlayedBeforeItIsLoadedToTheEnd) {
  for (const char* name : {"a.mp4", "a.mov"}) {
    ASSERT_EQ(failure_of_video(folder / name, 3, 64), "") << name;
    std::ifstream file(folder / name, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    ASSERT_NE(bytes.find("mdat"), bytes.npos) << name;
    EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << name << ": the index comes first";
  }
}

TEST_F(VideoTest, KeepsColours) {
  for (const Rgba color :
       {Rgba{200, 30, 40, 255}, Rgba{20, 160, 60, 255}, Rgba{30, 60, 220, 255}, Rgba{128, 128, 128, 255}}) {
    const auto video = make_video(folder / "a.mp4", 10);
    for (int i = 0; i < 3; ++i) video->add(plain_image(32, 32, color));
    video->finish();
    output_of("ffmpeg -v error -y -i '" + (folder / "a.mp4").string() + "' -frames:v 1 '" +
              (folder / "a.png").string() + "'");
    const Image back = read_png(folder / "a.png");
    EXPECT_NEAR(back.at(16, 16)[0], color.r, 4);
    EXPECT_NEAR(back.at(16, 16)[1], color.g, 4);
    EXPECT_NEAR(back.at(16, 16)[2], color.b, 4);
  }
}

TEST_F(VideoTest, WithoutFinishNothingIsLeft) {
  std::ofstream(folder / "a.mp4") << "an earlier video";
  {
    const auto video = make_video(folder / "a.mp4", 25);
    for (unsigned i = 0; i < 5; ++i) video->add(noise_image(64, 64, i + 1));
    EXPECT_EQ(folder.entries(), 2);
  }
  EXPECT_EQ(folder.entries(), 1);
  EXPECT_EQ(fs::file_size(folder / "a.mp4"), 16u);
}

TEST_F(VideoTest, FullDisk) {
  const SmallDisk disk(folder.path(), 128 << 10);
  if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a small disk";
  for (const char* name : {"a.mp4", "a.mkv", "a.gif"}) {
    const std::string error = failure_of_video(folder / name, 60, 128);
    EXPECT_TRUE(holds(error, name)) << error;
    EXPECT_TRUE(holds(error, "No space left on device")) << error;
    EXPECT_EQ(folder.entries(), 0) << name;
  }
}

TEST_F(VideoTest, BadTargets) {
  EXPECT_TRUE(holds(failure_of_video(folder / "a.txt", 1, 8), ".mp4"));
  EXPECT_TRUE(holds(failure_of_video(folder / "none/a.mp4", 1, 8), "No such file or directory"));
  EXPECT_TRUE(holds(failure_of_video(folder / "a.mp4", 0, 8), "no frames"));
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Video, MissingFfmpegNamesThePackageAndTheWayAround) {
  TemporaryFolder folder;
  const OnlyPath path(folder.path());
  const std::string error = failure_of_video(folder / "a.mp4", 1, 8);
  EXPECT_TRUE(holds(error, "install the package ffmpeg")) << error;
  EXPECT_TRUE(holds(error, "folder of pictures")) << error;
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Video, FfmpegsFirstComplaintIsReported) {
  TemporaryFolder programs, folder;
  write_program(programs / "ffmpeg", "echo 'Unknown encoder libx264' >&2; echo more >&2; exit 1\n");
  const OnlyPath path(programs.path());
  // More frames than a socket holds: sending to a program that is gone must not end ours.
  const std::string error = failure_of_video(folder / "a.mp4", 50, 128);
  EXPECT_TRUE(holds(error, "ffmpeg: Unknown encoder libx264)")) << error;
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Video, ANoisyOrIdleProgramDoesNotBlockUs) {
  TemporaryFolder programs, folder;
  const OnlyPath path(programs.path().string() + ":/usr/bin:/bin");
  write_program(programs / "ffmpeg", "head -c 300000 /dev/zero | tr '\\0' 'x' >&2; cat > /dev/null; exit 3\n");
  EXPECT_TRUE(holds(failure_of_video(folder / "a.mp4", 20, 128), "ffmpeg: xxx"));
  write_program(programs / "ffmpeg", "exec sleep 100\n");
  { make_video(folder / "a.mp4", 25)->add(noise_image(8, 8)); }
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Video, StopsOnRequestAndLeavesNothing) {
  TemporaryFolder programs, folder;
  const OnlyPath path(programs.path().string() + ":/usr/bin:/bin");
  write_program(programs / "ffmpeg", "cat > /dev/null; sleep 100\n");
  std::atomic<bool> stop{false};
  {
    const auto video = make_video(folder / "a.mp4", 25, &stop);
    video->add(noise_image(8, 8));
    stop = true;
    EXPECT_THROW(video->finish(), Interrupted);
  }
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace nacre
