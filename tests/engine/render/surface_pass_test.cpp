// Nacre: the surface as OpenGL draws it, against the picture that rays make of the same scene.
#include "engine/render/surface_pass.hpp"

#include <bit>
#include <cmath>
#include <cstdlib>

#include "engine/gl/framebuffer.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/png.hpp"
#include "tests/engine/gl/offscreen.hpp"
#include "tests/engine/render/flow_scene.hpp"

namespace nacre {
namespace {

using Render = test::Offscreen;

struct Difference {
  double mean = 0;     ///< of all channels, 0..255
  double far_off = 0;  ///< share of the pixels that differ by more than 16 in a channel
  double covered = 0;  ///< share of the pixels that are not background
};

Difference compare(const Image& a, const Image& b) {
  Difference d;
  const std::size_t pixels = std::size_t(a.width) * std::size_t(a.height);
  for (std::size_t i = 0; i < pixels; ++i) {
    int most = 0, background = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int difference = std::abs(int(a.pixels[4 * i + c]) - int(b.pixels[4 * i + c]));
      most = std::max(most, difference);
      d.mean += difference;
      background += b.pixels[4 * i + c] == 255;
    }
    d.far_off += most > 16;
    d.covered += background < 3;
  }
  d.mean /= 3 * double(pixels);
  d.far_off /= double(pixels);
  d.covered /= double(pixels);
  return d;
}

/// Both pictures of a scene, one sample a pixel; kept where NACRE_KEEP_PICTURES names a folder.
class TwoPictures {
 public:
  TwoPictures(test::FlowScene& scene, const Camera& camera, const std::vector<float>& scalar, std::size_t page = 0)
      : camera_(camera) {
    RenderOptions options;
    options.camera = camera;
    options.width = width;
    options.height = height;
    options.samples = 1;
    options.scalar = scalar;
    options.low = 0;
    options.high = 1;
    options.colours = colormap("sea").table;
    rays.width = width;
    rays.height = height;
    rays.pixels = scene.pipeline->flow().render(options);
    draw(scene, scalar, page);
  }

  void keep(const std::string& name) const {
    const char* folder = std::getenv("NACRE_KEEP_PICTURES");
    if (!folder) return;
    write_png(std::filesystem::path(folder) / (name + "_rays.png"), rays);
    write_png(std::filesystem::path(folder) / (name + "_opengl.png"), opengl);
  }

  static constexpr int width = 320, height = 240;
  Image rays, opengl;

 private:
  void draw(test::FlowScene& scene, const std::vector<float>& scalar, std::size_t page) {
    const SurfaceBuffers surface(scene.geometry());
    SurfacePass pass;
    pass.set_texture(scene.texture(page), scene.layout);
    SurfaceColours colours;
    colours.set_map(colormap("sea").table);
    if (!scalar.empty()) colours.set_scalar(scalar, 0, 1);
    View view;
    view.camera = camera_;
    view.width = width;
    view.height = height;
    view.light = flow_light(camera_);
    const Framebuffer frame(width, height);
    frame.bind();
    frame.clear({1, 1, 1, 1});
    pass.draw(view, surface, colours, &scene.shown->texture());
    scene.shown->drawn();
    opengl = frame.read();
  }

  Camera camera_;
};

/// Something smooth to colour by.
std::vector<float> heights(const test::FlowScene& scene) {
  std::vector<float> scalar;
  for (const Vec3d& p : scene.surface.points) scalar.push_back(float(0.5 + 0.6 * p.z));
  return scalar;
}

/// `far_off`: along the outline a pixel's middle may be on one side or the other.
void expect_alike(const TwoPictures& two, double covered, double mean, double far_off) {
  const Difference d = compare(two.opengl, two.rays);
  EXPECT_GT(d.covered, covered);
  EXPECT_LT(d.mean, mean);
  EXPECT_LT(d.far_off, far_off);
}

TEST_F(Render, SurfaceLooksAsRaysSeeIt) {
  test::FlowScene scene("sphere", 24, 128);
  const Camera camera = fit_camera("iso", scene.surface.points, TwoPictures::width, TwoPictures::height);
  const TwoPictures two(scene, camera, heights(scene));
  two.keep("sphere");
  expect_alike(two, 0.3, 0.5, 0.005);
}

TEST_F(Render, OrthographicCamerasAgreeToo) {
  test::FlowScene scene("torus", 32, 128);
  Camera camera = fit_camera("+x", scene.surface.points, TwoPictures::width, TwoPictures::height);
  camera.orthographic = true;
  const TwoPictures two(scene, camera, {});
  two.keep("torus_orthographic");
  expect_alike(two, 0.2, 0.5, 0.01);
}

TEST_F(Render, TextureIsSharpFromNearby) {
  test::FlowScene scene("sphere", 24, 128);
  Camera camera = fit_camera("iso", scene.surface.points, TwoPictures::width, TwoPictures::height);
  // A twentieth of the picture fills it: every texture cell is some dozen pixels wide.
  const Vec3d nearest = camera.target - camera.forward() * (0.95 * length(scene.surface.points[0] - camera.target));
  camera.eye = nearest + (camera.eye - nearest) * 0.05;
  camera.target = nearest;
  camera.height *= 0.05;
  const TwoPictures two(scene, camera, {});
  two.keep("near");
  expect_alike(two, 0.9, 1, 0.01);
}

TEST_F(Render, OddDivisorsAgreeToo) {
  test::FlowScene scene("sphere", 24, 96, 3);
  const Camera camera = fit_camera("-y", scene.surface.points, TwoPictures::width, TwoPictures::height);
  const TwoPictures two(scene, camera, {});
  expect_alike(two, 0.3, 0.5, 0.005);
}

TEST_F(Render, ArraysOnSeveralPagesLookTheSame) {
  test::FlowScene scene("sphere", 24, 96);
  const Camera camera = fit_camera("iso", scene.surface.points, TwoPictures::width, TwoPictures::height);
  const std::size_t page = std::bit_ceil(2 * scene.pipeline->flow().lookup().texel.size()) / 4;  // with their rims
  const TwoPictures one(scene, camera, {}), paged(scene, camera, {}, page);
  EXPECT_EQ(one.opengl.pixels, paged.opengl.pixels);
  EXPECT_THROW(scene.texture(page / 8), Error);  // more pages than there are texture units for
}

TEST_F(Render, OctreesLookAsRaysSeeThem) {
  for (const int resolution : {64, 100}) {
    test::FlowScene scene("sphere", 24, resolution, 4, "brick");
    const Camera camera = fit_camera("iso", scene.surface.points, TwoPictures::width, TwoPictures::height);
    const TwoPictures two(scene, camera, heights(scene));
    two.keep("octree");
    expect_alike(two, 0.3, 0.5, 0.005);
  }
}

TEST_F(Render, TheThesisOctreeLooksAsRaysSeeIt) {
  test::FlowScene scene("sphere", 24, 64, 4, "thesis");
  const Camera camera = fit_camera("iso", scene.surface.points, TwoPictures::width, TwoPictures::height);
  const TwoPictures two(scene, camera, heights(scene));
  two.keep("source_octree");
  expect_alike(two, 0.3, 0.5, 0.005);
  const std::size_t page = std::bit_ceil(scene.pipeline->flow().lookup().child.size()) / 4;
  const TwoPictures paged(scene, camera, heights(scene), page);
  EXPECT_EQ(two.opengl.pixels, paged.opengl.pixels);
}

TEST_F(Render, OctreesLieOnPagesToo) {
  test::FlowScene scene("torus", 32, 128, 4, "brick");
  const Camera camera = fit_camera("+x", scene.surface.points, TwoPictures::width, TwoPictures::height);
  const std::size_t page = std::bit_ceil(scene.pipeline->flow().lookup().layer.size()) / 4;
  const TwoPictures one(scene, camera, {}), paged(scene, camera, {}, page);
  EXPECT_EQ(one.opengl.pixels, paged.opengl.pixels);
}

TEST_F(Render, EachStepIsSeenWithoutACopy) {
  test::FlowScene scene("sphere", 24, 64);
  const Camera camera = fit_camera("iso", scene.surface.points, TwoPictures::width, TwoPictures::height);
  const TwoPictures before(scene, camera, {});
  scene.step();
  const TwoPictures after(scene, camera, {});
  EXPECT_GT(compare(before.opengl, after.opengl).mean, 2);  // it has moved
  EXPECT_LT(compare(after.opengl, after.rays).mean, 0.5);
  EXPECT_EQ(scene.shown->copied_bytes(), 0u);
}

TEST_F(Render, ClipPlaneCutsHalfAway) {
  const test::FlowScene scene("sphere", 24, 64);
  const SurfaceBuffers surface(scene.geometry());
  const SurfacePass pass;
  SurfaceColours colours;
  colours.set_map(colormap("sea").table);
  View view;
  view.camera = fit_camera("-y", scene.surface.points, 200, 200);
  view.width = view.height = 200;
  view.light = flow_light(view.camera);
  const Framebuffer frame(200, 200);
  const auto covered = [&] {
    frame.bind();
    frame.clear({1, 1, 1, 1});
    pass.draw(view, surface, colours, nullptr);
    const Image image = frame.read();
    std::array<int, 2> sides{};
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) sides[x < 100 ? 0 : 1] += image.at(x, y)[0] != 255;
    return sides;
  };
  const auto whole = covered();
  view.clip = ClipPlanes({{2, 0, 0}, 2 * view.camera.target.x});  // a normal need not be a unit vector
  const auto half = covered();
  EXPECT_NEAR(whole[0], whole[1], 0.02 * whole[0]);
  EXPECT_LT(half[0], 0.01 * whole[0]);
  EXPECT_NEAR(half[1], whole[1], 0.01 * whole[1]);
  view.clip.add({{0, 0, 1}, view.camera.target.z});
  const auto quarter = covered();
  EXPECT_LT(quarter[0], 0.01 * whole[0]);
  EXPECT_NEAR(quarter[1], 0.5 * whole[1], 0.02 * whole[1]);
}

}  // namespace
}  // namespace nacre
