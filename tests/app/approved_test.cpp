// Nacre: pictures that someone has looked at and approved, and what the viewer draws today. After a change that is
// meant, NACRE_APPROVE=1 writes them again: look at each before it is committed.
#include <cstdlib>

#include "engine/picture/compose.hpp"
#include "engine/picture/png.hpp"
#include "tests/app/picture_likeness.hpp"
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

struct Approved {
  std::string name;
  Arguments arguments;
  bool crowd = false;  ///< of particles, whose positions follow from the last bit of a sum
};

const Arguments flow_words = {"--sample", "torus", "--detail", "48", "--resolution", "160", "--steps", "6"};
const Arguments mesh_words = {"--sample", "three-sectors", "--detail", "24", "--set", "iterations=40"};

void PrintTo(const Approved& approved, std::ostream* out) { *out << approved.name; }

Approved of_flow(const std::string& name, const Arguments& more) { return {name, flow_words + more}; }
Approved of_mesh(const std::string& name, const Arguments& more) { return {name, mesh_words + more}; }
Approved of_particles(const std::string& name, const Arguments& more) {
  return {name, mesh_words + Arguments{"--frames-count", "56"} + more, true};
}
Arguments tab(const std::string& name) { return {"--panel", "--set", "tab=" + name}; }

/// Every tab of the panel for both jobs, and what the look can do.
const std::vector<Approved> all = {
    of_flow("flow", {}),
    of_flow("flow_octree", {"--method", "octree", "--background", "#203040"}),
    of_flow("flow_arrows", {"--set", "arrows=true", "--set", "arrow_count=400", "--color", "none"}),
    of_flow("flow_topology", {"--topology", "--streamlines", "--line-spacing", "0.05"}),
    of_flow("flow_boxes", {"--method", "octree", "--set", "boxes=true", "--color", "none"}),
    of_flow("flow_source", {"--method", "octree", "--octree", "source", "--set", "resolution=96"}),
    of_flow("flow_clip", {"--set", "clip=x", "--set", "edges=true", "--set", "light_azimuth=60"}),
    of_flow("flow_data", tab("data")),
    of_flow("flow_knobs", tab("knobs")),
    of_flow("flow_look", tab("look") + Arguments{"--set", "theme=light"}),
    of_flow("flow_result", tab("result")),
    of_mesh("mesh", {"--set", "edges=true"}),
    of_particles("mesh_particles", {}),
    of_particles("mesh_boxes", {"--set", "boxes=true"}),
    of_mesh("mesh_ghost", {"--set", "ghosts=1", "--set", "hidden=2", "--set", "worst=8"}),
    of_mesh("mesh_slice", {"--set", "slice=z", "--set", "slice_field=distance", "--set", "clip=z"}),
    of_mesh("mesh_data", tab("data")),
    of_mesh("mesh_knobs", tab("knobs")),
    of_mesh("mesh_look", tab("look")),
    of_mesh("mesh_result", tab("result")),
};

class ApprovedPicture : public ViewTest, public testing::WithParamInterface<Approved> {};

/// Timings and memory differ from run to run: the status line, and a line of times in the panel.
void paint_over_status(Image& image) {
  for (int y = image.height - 28; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) *image.at(x, y) = 0;
}

TEST_P(ApprovedPicture, IsDrawn) {
  const bool panel =
      std::find(GetParam().arguments.begin(), GetParam().arguments.end(), "--panel") != GetParam().arguments.end();
  const Arguments size = {"--size", panel ? "640x480" : "240x180"};
  const fs::path drawn = folder / "drawn.png";
  const fs::path approved = source_file("tests/app/approved/" + GetParam().name + ".png");
  const Outcome outcome =
      nacre(Arguments{"view", "--offscreen", "--quiet", "--image", drawn.string()} + GetParam().arguments + size);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  if (std::getenv("NACRE_APPROVE")) fs::copy_file(drawn, approved, fs::copy_options::overwrite_existing);
  ASSERT_TRUE(fs::exists(approved)) << "run with NACRE_APPROVE=1 and look at it";
  Image a = read_png(drawn), b = read_png(approved);
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  if (panel) paint_over_status(a), paint_over_status(b);
  EXPECT_TRUE(GetParam().crowd ? are_alike(a, b) : are_same(a, b));
  if (testing::Test::HasFailure())
    fs::copy_file(drawn, fs::path(testing::TempDir()) / (GetParam().name + ".png"),
                  fs::copy_options::overwrite_existing);
}

/// What the quick tests leave out.
bool is_long(const Approved& approved) {
  for (const char* name : {"flow_source", "flow_boxes", "flow_clip", "flow_look", "flow_result", "mesh_boxes",
                           "mesh_ghost", "mesh_knobs", "mesh_look"})
    if (approved.name == name) return true;
  return false;
}

std::vector<Approved> chosen(bool of_long) {
  std::vector<Approved> some;
  for (const Approved& each : all)
    if (is_long(each) == of_long) some.push_back(each);
  return some;
}

std::string name_of(const testing::TestParamInfo<Approved>& approved) { return approved.param.name; }

INSTANTIATE_TEST_SUITE_P(, ApprovedPicture, testing::ValuesIn(chosen(false)), name_of);
INSTANTIATE_TEST_SUITE_P(Long, ApprovedPicture, testing::ValuesIn(chosen(true)), name_of);

TEST(ApprovedPictures, AreSmall) {
  std::uintmax_t bytes = 0;
  for (const auto& file : fs::directory_iterator(source_file("tests/app/approved"))) bytes += file.file_size();
  EXPECT_LT(bytes, 1500000u);
}

}  // namespace
}  // namespace nacre::test
