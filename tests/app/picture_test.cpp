// Nacre: tests of the pictures, frames and videos that the program leaves.
#include <cmath>

#include "engine/picture/png.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using Rgb = std::array<int, 3>;

Rgb pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = image.at(x, y);
  return {p[0], p[1], p[2]};
}

double brightness(const Image& image, int x, int y) {
  const Rgb p = pixel(image, x, y);
  return (p[0] + p[1] + p[2]) / 3.0;
}

/// Standard deviation of the brightness in a box around the middle, `half` pixels to each side.
double deviation_in_the_middle(const Image& image, int half) {
  double sum = 0, squares = 0;
  int n = 0;
  for (int y = image.height / 2 - half; y <= image.height / 2 + half; ++y)
    for (int x = image.width / 2 - half; x <= image.width / 2 + half; ++x, ++n) {
      sum += brightness(image, x, y);
      squares += std::pow(brightness(image, x, y), 2);
    }
  return std::sqrt(squares / n - std::pow(sum / n, 2));
}

int differing_pixels(const Image& a, const Image& b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) count += pixel(a, x, y) != pixel(b, x, y);
  return count;
}

class Picture : public AppTest {
 protected:
  /// The picture of a small run with these arguments more.
  Image picture(const Arguments& arguments, const std::string& name = "a.png",
                const Arguments& size = {"--size", "240x180"}) {
    const Outcome run = nacre(small_flow + size + Arguments{"--image", path(name)} + arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    return read_png(path(name));
  }
};

const Arguments plain = {"--no-legend", "--no-time"};

TEST_F(Picture, HasTheSizeTheTextureAndTheBackground) {
  const Image image = picture(plain);
  EXPECT_EQ(image.width, 240);
  EXPECT_EQ(image.height, 180);
  EXPECT_GT(deviation_in_the_middle(image, 40), 8) << "a sphere with texture, not a plain disk";
  for (const auto& [x, y] : {std::pair{0, 0}, {239, 0}, {0, 179}, {239, 179}, {5, 90}, {234, 90}})
    EXPECT_EQ(pixel(image, x, y), (Rgb{255, 255, 255})) << x << " " << y;
  EXPECT_EQ(content("a.png").substr(1, 3), "PNG");
  EXPECT_EQ(names(), Arguments{"a.png"});
}

TEST_F(Picture, LegendAndTimeStampCanBeTurnedOff) {
  const Image bare = picture(plain, "bare.png", {"--size", "400x300"});
  const Image legend = picture({"--no-time"}, "legend.png", {"--size", "400x300"});
  const Image time = picture({"--no-legend"}, "time.png", {"--size", "400x300"});
  EXPECT_GT(differing_pixels(bare, legend), 500);
  EXPECT_GT(differing_pixels(bare, time), 50);
  EXPECT_LT(differing_pixels(bare, time), 3000) << "a line of text, not another picture";
  EXPECT_EQ(pixel(bare, 399, 150), (Rgb{255, 255, 255}));
}

TEST_F(Picture, TransparentOrColouredBackground) {
  const Image clear = picture(plain + Arguments{"--background", "transparent"});
  EXPECT_EQ(clear.at(0, 0)[3], 0);
  EXPECT_EQ(clear.at(120, 90)[3], 255);
  const Image blue = picture(plain + Arguments{"--background", "#102080"});
  EXPECT_EQ(pixel(blue, 0, 0), (Rgb{0x10, 0x20, 0x80}));
}

TEST_F(Picture, CamerasLookFromWhereTheySay) {
  // A triangle that faces +z, seen from above and edge-on.
  write("flat.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto covered = [&](const std::string& camera) {
    const Outcome run =
        nacre({"flow", path("flat.obj"), "--vectors", "@rotation", "--resolution", "48", "--steps", "1", "--quiet",
               "--no-legend", "--no-time", "--size", "160x120", "--camera", camera, "--image", path("a.png")});
    EXPECT_EQ(run.status, 0) << run.err;
    const Image image = read_png(path("a.png"));
    int count = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) count += pixel(image, x, y) != Rgb{255, 255, 255};
    return count;
  };
  const int above = covered("+z");
  EXPECT_GT(above, 2000);
  EXPECT_LT(covered("+x"), above / 4);
  // Orthographic, 2 world units high: the triangle of area 1 covers (120 / 2)^2 pixels.
  write("camera.json", R"({"eye":[0.7,0.3,5],"target":[0.7,0.3,0],"up":[0,1,0],"height":2,"orthographic":true})");
  EXPECT_NEAR(covered(path("camera.json")), 3600, 250);
}

TEST_F(Picture, BadCamerasAreNamed) {
  const auto with = [&](const std::string& file) {
    return nacre(small_flow + Arguments{"--camera", file, "--image", path("a.png")});
  };
  expect_failure(with(path("none.json")), 1, {"none.json"});
  expect_failure(with(write("text.json", "no json")), 1, {"text.json", "eye"});
  expect_failure(with(write("half.json", R"({"eye":[1,2,3]})")), 1, {"half.json", "target"});
  expect_failure(with(write("short.json", R"({"eye":[1,2],"target":[0,0,0]})")), 1, {"short.json"});
  expect_failure(with(write("word.json", R"({"eye":"far","target":[0,0,0]})")), 1, {"word.json"});
  expect_failure(with(write("same.json", R"({"eye":[0,0,0],"target":[0,0,0]})")), 1, {"same.json", "differ"});
  EXPECT_FALSE(exists("a.png"));
}

TEST_F(Picture, FramesAreCountedAndWhole) {
  const Outcome run = nacre(small_flow + Arguments{"--size", "96x72", "--frames", path("frames")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, path("frames") + "\n");
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(path("frames"))) {
    const Image image = read_png(entry.path());
    EXPECT_EQ(std::pair(image.width, image.height), std::pair(96, 72));
    ++count;
  }
  EXPECT_EQ(count, 2u);
  const Image first = read_png(path("frames/frame_0000.png")), last = read_png(path("frames/frame_0001.png"));
  EXPECT_GT(differing_pixels(first, last), 200) << "the texture moves";
}

TEST_F(Picture, TheLastFrameIsThePicture) {
  const Outcome run =
      nacre(small_flow + Arguments{"--size", "96x72", "--frames", path("frames"), "--image", path("a.png")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(read_png(path("frames/frame_0001.png")).pixels, read_png(path("a.png")).pixels);
}

TEST_F(Picture, VideoHasEveryFrame) {
  const fs::path probe = find_program("ffprobe");
  if (probe.empty() || find_program("ffmpeg").empty()) GTEST_SKIP() << "ffmpeg and ffprobe are not installed";
  const Outcome made = nacre(small_flow + Arguments{"--size", "96x72", "--fps", "10", "--video", path("a.mp4")});
  EXPECT_EQ(made.status, 0) << made.err;
  const Outcome told = run(probe, {"-v", "error", "-count_frames", "-select_streams", "v:0", "-show_entries",
                                   "stream=width,height,r_frame_rate,nb_read_frames", "-of", "json", path("a.mp4")});
  const nlohmann::json stream = nlohmann::json::parse(told.out)["streams"][0];
  EXPECT_EQ(stream["width"], 96);
  EXPECT_EQ(stream["height"], 72);
  EXPECT_EQ(stream["r_frame_rate"], "10/1");
  EXPECT_EQ(stream["nb_read_frames"], "2");
  EXPECT_EQ(names(), Arguments{"a.mp4"});
}

}  // namespace
}  // namespace nacre::test
