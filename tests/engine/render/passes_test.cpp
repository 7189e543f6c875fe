// Nacre: materials, edges, boxes, particles and arrows, each in a scene whose picture can be told by hand.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "compute/raycast/mesh_picture.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/png.hpp"
#include "engine/render/arrow_pass.hpp"
#include "engine/render/line_passes.hpp"
#include "engine/render/material_pass.hpp"
#include "engine/render/particle_pass.hpp"
#include "engine/render/segment_pass.hpp"
#include "engine/render/slice_pass.hpp"
#include "tests/engine/gl/offscreen.hpp"

namespace nacre {
namespace {

using Pass = test::Offscreen;
using Pixel = std::array<int, 3>;
const Placement world(1.0);

/// Looks along y at the square -1..1 of the xz plane, which fills the picture.
View front(int size = 100) {
  View view;
  view.camera.eye = {0, -10, 0};
  view.camera.target = {0, 0, 0};
  view.camera.up = {0, 0, 1};
  view.camera.height = 2;
  view.width = view.height = size;
  view.light = mesh_light(view.camera);
  return view;
}

Pixel at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.at(x, y);
  return {p[0], p[1], p[2]};
}

/// Share of pixels that are not white.
double covered(const Image& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += at(image, x, y) != Pixel{255, 255, 255};
  return double(count) / image.width / image.height;
}

template <class Draw>
Image picture(const View& view, const Draw& draw) {
  const Framebuffer frame(view.width, view.height);
  frame.bind();
  frame.clear({1, 1, 1, 1});
  draw();
  return frame.read();
}

void keep(const Image& image, const std::string& name) {
  if (const char* folder = std::getenv("NACRE_KEEP_PICTURES"))
    write_png(std::filesystem::path(folder) / (name + ".png"), image);
}

/// Squares across the view: two triangles each, in planes y = depth.
struct Squares {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;

  void add(double depth, double size) {
    const std::uint32_t n = std::uint32_t(points.size());
    for (int k = 0; k < 4; ++k) points.push_back({(k & 1 ? size : -size), depth, (k & 2 ? size : -size)});
    triangles.push_back({n, n + 1, n + 2});
    triangles.push_back({n + 2, n + 1, n + 3});
  }
};

/// The inner square (material 2) lies behind the outer one (material 1).
class MaterialScene {
 public:
  MaterialScene() {
    Squares squares;
    squares.add(0, 0.8);
    squares.add(0.5, 0.4);
    buffers_ = SurfaceBuffers(make_surface_geometry(squares.points, squares.triangles, {}));
    pass_.set_materials(std::vector<std::array<std::uint16_t, 2>>{{0, 1}, {0, 1}, {0, 2}, {0, 2}});
  }

  Image draw(float first, float second) {
    pass_.set_styles(std::vector<MaterialStyle>{{}, {{1, 0, 0}, first}, {{0, 0, 1}, second}});
    const View view = front();
    return picture(view, [&] { pass_.draw(view, buffers_, world); });
  }

 private:
  SurfaceBuffers buffers_;
  MaterialPass pass_;
};

TEST_F(Pass, SolidMaterialsHideWhatIsBehind) {
  MaterialScene scene;
  const Image image = scene.draw(1, 1);
  const Pixel middle = at(image, 50, 50);
  EXPECT_GT(middle[0], 200);
  EXPECT_EQ(middle[2], 0);
  EXPECT_NEAR(covered(image), 0.64, 0.03);
}

TEST_F(Pass, HiddenMaterialsAreNotThere) {
  MaterialScene scene;
  const Image image = scene.draw(0, 1);
  EXPECT_EQ(at(image, 50, 50)[0], 0);
  EXPECT_GT(at(image, 50, 50)[2], 200);
  EXPECT_NEAR(covered(image), 0.16, 0.03);
}

TEST_F(Pass, GhostsLetTheRestShineThrough) {
  MaterialScene scene;
  const Image image = scene.draw(0.25f, 1);
  keep(image, "ghost");
  const Pixel middle = at(image, 50, 50), beside = at(image, 20, 50);
  EXPECT_GT(middle[2], 120);  // the blue one behind
  EXPECT_GT(middle[0], 30);   // through a red pane
  EXPECT_GT(beside[0], 200);
  EXPECT_NEAR(beside[2], 191, 3);  // white through it: 255 (1 - 0.25)
}

TEST_F(Pass, MaterialsLookAsInPicturesWithoutOpenGl) {
  Squares squares;
  squares.add(0, 0.8);
  squares.points[3].y = 0.6;  // one triangle is tilted
  const SurfaceBuffers buffers(make_surface_geometry(squares.points, squares.triangles, {}));
  MaterialPass pass;
  pass.set_materials(std::vector<std::array<std::uint16_t, 2>>{{0, 1}, {1, 2}});
  pass.set_styles(std::vector<MaterialStyle>{{}, {{0.9f, 0.5f, 0.2f}, 1}, {{0.1f, 0.5f, 0.8f}, 1}});
  const View view = front();
  const Image image = picture(view, [&] { pass.draw(view, buffers, world); });
  MeshPictureOptions options;
  options.camera = view.camera;
  options.width = options.height = 100;
  options.samples = 1;
  options.edges = false;
  const std::vector<std::array<float, 3>> colours{{0.9f, 0.5f, 0.2f}, {0.675f, 0.675f, 0.675f}};
  const std::vector<std::uint8_t> reference = mesh_picture(squares.points, squares.triangles, colours, options);
  for (const auto [x, y] : {std::array<int, 2>{20, 70}, {30, 80}, {75, 35}, {80, 20}})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(image.at(x, y)[c], reference[std::size_t(4 * (100 * y + x) + c)], 3) << x << " " << y;
}

TEST_F(Pass, EdgesAreDrawnOnceBeforeTheirTriangles) {
  Squares squares;
  squares.add(0, 0.8);
  const SurfaceGeometry geometry = make_surface_geometry(squares.points, squares.triangles, {});
  EXPECT_EQ(geometry.edges.size(), 5u);
  EXPECT_FALSE(geometry.closed);
  const SurfaceBuffers buffers(geometry);
  MaterialPass fill;
  fill.set_materials(std::vector<std::array<std::uint16_t, 2>>{{0, 1}, {0, 1}});
  fill.set_styles(std::vector<MaterialStyle>{{}, {{1, 0, 0}, 1}});
  const EdgePass edges;
  for (const bool orthographic : {false, true}) {
    View view = front();
    view.camera.orthographic = orthographic;
    const Image image = picture(view, [&] {
      fill.draw(view, buffers, world);
      edges.draw(view, buffers, world, {0, 0, 0, 1});
    });
    int dark = 0;
    for (int x = 0; x < 100; ++x) dark += at(image, x, 25)[0] < 60;
    EXPECT_GE(dark, 3) << orthographic;  // left, diagonal, right
    EXPECT_LE(dark, 6) << orthographic;
    EXPECT_GT(at(image, 30, 50)[0], 150);
  }
}

TEST_F(Pass, ClosedSurfacesAreFound) {
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Triangle> tetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_TRUE(make_surface_geometry(points, tetrahedron, {}).closed);
  std::vector<Triangle> turned = tetrahedron;
  std::swap(turned[0].a, turned[0].b);
  EXPECT_FALSE(make_surface_geometry(points, turned, {}).closed);
  EXPECT_FALSE(make_surface_geometry(points, std::span(tetrahedron).first(3), {}).closed);
  EXPECT_FALSE(make_surface_geometry(points, {}, {}).closed);
}

TEST_F(Pass, CornersShareAVertexWhereTheirNormalsAgree) {
  Squares squares;
  squares.add(0, 1);
  const Vec3f n(0, -1, 0), other(0, 0, 1);
  const std::vector<Vec3f> same(6, n);
  EXPECT_EQ(make_surface_geometry(squares.points, squares.triangles, same).vertices.size(), 4u);
  const std::vector<Vec3f> crease{n, n, n, other, other, other};
  EXPECT_EQ(make_surface_geometry(squares.points, squares.triangles, crease).vertices.size(), 6u);
}

TEST_F(Pass, BoxesAreDrawnFromTheRecordsOfABuild) {
  struct Node {  // as a tree might lay it out
    std::uint32_t first, last;
    Vec3f low, high;
    float more;
  };
  const std::vector<Node> nodes{{0, 1, Vec3f(-9), Vec3f(9), 0}, {0, 1, {-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, 0}};
  const Buffer buffer = Buffer::of<Node>(nodes);
  const BoxPass pass;
  View view = front();
  view.camera.orthographic = true;
  const Image image = picture(view, [&] {
    pass.draw_corners(view, world, buffer, {sizeof(Node), offsetof(Node, low), offsetof(Node, high)}, 1, 1,
                      {0, 0, 0, 1});
  });
  EXPECT_NEAR(covered(image), 4 * 50 / 10000.0, 0.004);  // one square of 50 pixels: front and back coincide
  EXPECT_LT(at(image, 50, 25)[0] + at(image, 50, 24)[0], 300);
}

TEST_F(Pass, BoxesOfMortonCodesLieWhereTheCodesSay) {
  const std::vector<std::uint64_t> codes{7 + (std::uint64_t(1) << 60), 6};  // the first is far away; then (0, 1, 1)
  const Buffer buffer = Buffer::of<std::uint64_t>(codes);
  const BoxPass pass;
  View view = front();
  view.camera.orthographic = true;
  const Image image = picture(view, [&] {
    pass.draw_codes(view, place_grid({0, 0, -1}, 1), buffer, 1, 1, 0.5f, {0, 0, 0, 1});
  });
  // Cube x 0..0.5, z -1 + 0.5..-1 + 1: columns 50..75, rows 50..75.
  EXPECT_NEAR(covered(image), 4 * 25 / 10000.0, 0.003);
  EXPECT_LT(at(image, 60, 50)[0] + at(image, 60, 49)[0], 300);
}

TEST_F(Pass, ParticlesAreDiscsOnTheirSurface) {
  const std::vector<std::array<float, 4>> positions{{-0.5f, 0, 0, 1}, {0.5f, 0, 0, 1}};
  const std::vector<std::array<float, 4>> headings{{0, -1, 0, 0}, {1, 0, 0, 1}};  // facing us, and from the side
  const Buffer position = Buffer::of<std::array<float, 4>>(positions),
               heading = Buffer::of<std::array<float, 4>>(headings);
  ParticlePass pass;
  pass.set_map(colormap("sea").table);
  View view = front();
  view.camera.orthographic = true;
  const auto draw = [&](std::size_t first, std::size_t count, bool face) {
    ParticleStyle look;
    look.size = 0.2f;
    look.face_camera = face;
    return picture(view, [&] { pass.draw(view, world, position, heading, first, count, look); });
  };
  const double disc = 3.14159 * 10 * 10 / 10000;  // radius 0.2 is 10 pixels
  EXPECT_NEAR(covered(draw(0, 1, false)), disc, 0.1 * disc);
  EXPECT_LT(covered(draw(1, 1, false)), 0.2 * disc);
  const Image both = draw(0, 2, true);
  keep(both, "particles");
  EXPECT_NEAR(covered(both), 2 * disc, 0.2 * disc);
  EXPECT_NE(at(both, 25, 50), at(both, 75, 50));  // energies 0 and 1
  EXPECT_EQ(covered(draw(0, 0, true)), 0);
  ParticleStyle half;
  half.size = 0.2f;
  half.face_camera = true;
  half.every = 2;
  const Image one = picture(view, [&] { pass.draw(view, world, position, heading, 0, 2, half); });
  EXPECT_NEAR(covered(one), 2 * disc, 0.2 * disc) << "half as many, of twice the area";
  EXPECT_NE(at(one, 25, 50), at(one, 75, 50)) << "the second one is left out";
}

TEST_F(Pass, FewerParticlesAreDrawnThanThereArePixels) {
  View view = front();
  view.width = 900;
  view.height = 700;
  view.camera.height = 2;
  EXPECT_EQ(particle_share(view, 100'000, 2), 1u);
  EXPECT_EQ(particle_share(view, 1'600'000, 2), 7u);
  view.camera.height = 0.2;  // few of them are seen
  EXPECT_EQ(particle_share(view, 1'600'000, 2), 1u);
  EXPECT_EQ(particle_share(view, 0, 0), 1u);
}

/// An arrow from the middle of the picture to the right, on a surface that faces us.
Image arrow_picture(float scale, const Vec3f& vector, bool mapped = false) {
  ArrowPass pass;
  pass.set_map(colormap("sea").table);
  pass.set_arrows(std::vector<Arrow>{{{0, 0, 0}, vector, {0, -1, 0}, 1}});
  const View view = front();
  ArrowStyle look;
  look.scale = scale;
  look.width = 0.3f;
  look.ink = {0, 0, 0.8f};
  look.mapped = mapped;
  return picture(view, [&] { pass.draw(view, world, look); });
}

TEST_F(Pass, ArrowsPointAlongTheirVectors) {
  const Image image = arrow_picture(0.5f, {1.2f, 0, 0});  // 0.6 to the right: 30 pixels from the middle
  keep(image, "arrow");
  const auto ink = [&](int x, int y) { return at(image, x, y) != Pixel{255, 255, 255}; };
  int left = 100, right = 0, low = 0, high = 100;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x)
      if (ink(x, y))
        left = std::min(left, x), right = std::max(right, x), high = std::min(high, y), low = std::max(low, y);
  EXPECT_NEAR(left, 50, 2);
  EXPECT_NEAR(right, 80, 2);
  EXPECT_NEAR(low + high, 99, 2);  // on both sides of its axis
  EXPECT_NEAR(low - high, 10, 4);  // short ones have small heads: 0.17 of the length each way
  EXPECT_TRUE(ink(55, 50));        // the shaft
  EXPECT_FALSE(ink(55, 54));       // is thinner than the head
  EXPECT_LT(covered(arrow_picture(0, {1, 0, 0})), 1e-9);
  EXPECT_LT(covered(arrow_picture(1, {0, 0, 0})), 1e-9);
  EXPECT_GT(covered(arrow_picture(1, {1.2f, 0, 0})), 2 * covered(image));
}

TEST_F(Pass, ArrowsTakeTheMapsColours) {
  const auto& last = colormap("sea").table.back();
  const Image plain = arrow_picture(0.5f, {1.2f, 0, 0}), mapped = arrow_picture(0.5f, {1.2f, 0, 0}, true);
  EXPECT_EQ(at(plain, 55, 50)[0], 0);
  EXPECT_GT(at(plain, 55, 50)[2], 80);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(at(mapped, 55, 49)[k], 255 * last[std::size_t(k)], 90) << k;
}

TEST_F(Pass, SegmentsHaveTheirWidthAndLieBehindWhatIsBeforeThem) {
  const SegmentPass pass;
  const Buffer segments = Buffer::of<LineSegment>(std::vector<LineSegment>{{{-0.5f, 1, 0}, {0.5f, 1, 0}}});
  const View view = front();
  const auto draw = [&](float width, bool through) {
    return picture(view, [&] {
      const Buffer before = Buffer::of<LineSegment>(std::vector<LineSegment>{{{0, 0, -1}, {0, 0, 1}}});
      pass.draw(view, world, before, {{0, 0, 1, 1}, 10, false});
      glEnable(GL_DEPTH_TEST);
      pass.draw(view, world, segments, {{1, 0, 0, 1}, width, through});
    });
  };
  const Image narrow = draw(4, false), wide = draw(8, false);
  EXPECT_NEAR(covered(wide) - covered(narrow), 4 * 36 / 1e4, 0.006);
  EXPECT_EQ(at(narrow, 30, 50), (Pixel{255, 0, 0}));
  EXPECT_EQ(at(narrow, 30, 58), (Pixel{255, 255, 255}));
  View behind = view;  // an end that lies behind the eye does not turn the line round
  behind.camera.eye = {0, -1, 0};
  behind.camera.target = {0, 0, 0};
  const Buffer past = Buffer::of<LineSegment>(std::vector<LineSegment>{{{0.2f, 5, 0}, {0.2f, -20, 0}}});
  const Image image = picture(behind, [&] { pass.draw(behind, world, past, {{1, 0, 0, 1}, 4, false}); });
  EXPECT_EQ(at(image, 80, 50), (Pixel{255, 0, 0}));
  EXPECT_EQ(at(image, 20, 50), (Pixel{255, 255, 255}));
}

TEST_F(Pass, ASliceLiesWhereItIsPutAndIsNotCut) {
  SlicePass pass;
  View view = front();
  EXPECT_EQ(covered(picture(view, [&] { pass.draw(view); })), 0);
  Image image(2, 1);
  const std::uint8_t red_and_nothing[] = {255, 0, 0, 255, 0, 0, 0, 0};
  std::copy_n(red_and_nothing, 8, image.pixels.begin());
  pass.set_image(image, false);
  pass.set_frame({-0.5, 0, -0.5}, {1, 0, 0}, {0, 0, 1});
  view.clip = ClipPlanes({{1, 0, 0}, 0.9});
  const Image drawn = picture(view, [&] { pass.draw(view); });
  EXPECT_NEAR(covered(drawn), 0.125, 0.01);
  EXPECT_EQ(at(drawn, 40, 50), (Pixel{255, 0, 0}));
  EXPECT_EQ(at(drawn, 60, 50), (Pixel{255, 255, 255}));
}

}  // namespace
}  // namespace nacre
