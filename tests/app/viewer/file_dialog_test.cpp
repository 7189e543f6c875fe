// Nacre: the dialog that picks a file, by mouse and keys. No OpenGL here.

#include "app/viewer/panel/file_dialog.hpp"

#include <fstream>

#include "tests/app/imgui_frames.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre::test {
namespace {

namespace fs = std::filesystem;

class FileDialogTest : public ImGuiFrames {
 protected:
  static constexpr float width = 800, height = 600;

  void SetUp() override {
    fs::create_directory(folder_ / "inner");
    std::ofstream(folder_ / "inner" / "a.vtp") << "a";
    begin(width, height);
  }

  void draw() override {
    if (const auto files = dialog_.draw()) chosen_ = *files;
  }

  /// Opens it in the folder, by its path.
  void open(FileDialog::Mode mode) {
    dialog_.open(mode, "pick", {".vtp"});
    settle();
    type(folder_.path().string());
    press(enter_key);
    settle();
  }

  /// Clicks the only row of the list, which is the folder "inner": the first thing that the mouse meets on its way up
  /// from where the list has nothing more.
  void click_folder() {
    float y = 0.5f * height;
    for (over_ = false; y > 0 && !over_; y -= 4) move(0.5f * width, y), frame();
    ASSERT_GT(y, 0);
    click(0.5f * width, y);
    settle();
  }

  /// The keyboard goes where it was sent a frame or two later.
  void settle() {
    for (int k = 0; k < 3; ++k) frame();
  }

  TemporaryFolder folder_;
  FileDialog dialog_;
  std::vector<fs::path> chosen_;
};

TEST_F(FileDialogTest, AFolderThatWasClickedIsEnteredWithEnter) {
  open(FileDialog::Mode::open);
  click_folder();
  press(enter_key);
  settle();
  type("a.vtp");
  press(enter_key);
  ASSERT_EQ(chosen_.size(), 1u);
  EXPECT_EQ(chosen_[0], folder_ / "inner" / "a.vtp");
}

TEST_F(FileDialogTest, AfterAClickOnAFolderANameCanBeTyped) {
  open(FileDialog::Mode::open);
  click_folder();
  type("b.vtp");
  press(enter_key);
  ASSERT_EQ(chosen_.size(), 1u);
  EXPECT_EQ(chosen_[0], folder_ / "b.vtp");
}

TEST_F(FileDialogTest, WhereItSavesAClickOnAFolderLeavesTheName) {
  open(FileDialog::Mode::save);
  type("c.vtp");
  click_folder();
  press(enter_key);
  ASSERT_EQ(chosen_.size(), 1u);
  EXPECT_EQ(chosen_[0], folder_ / "c.vtp");
}

}  // namespace
}  // namespace nacre::test
