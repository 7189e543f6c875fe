// Nacre: tests of the small pictures of recent files.
#include "app/viewer/window/thumbnails.hpp"

#include "tests/engine/gl/offscreen.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

class ThumbnailsOnDisk : public test::Offscreen {
 protected:
  const Image picture_{Thumbnails::width, Thumbnails::height};
  test::TemporaryFolder folder_;
};

TEST_F(ThumbnailsOnDisk, AreThereInTheNextRunUnderAnyNameOfTheFile) {
  {
    Thumbnails first(folder_ / "thumbnails");
    EXPECT_EQ(first.texture("a.vtp"), 0u);
    first.keep("a.vtp", picture_);
    EXPECT_NE(first.texture("a.vtp"), 0u) << "what was missing is looked for again";
  }
  Thumbnails second(folder_ / "thumbnails");
  EXPECT_NE(second.texture(fs::absolute("a.vtp")), 0u);
  EXPECT_EQ(second.texture("b.vtp"), 0u);
}

TEST_F(ThumbnailsOnDisk, GoWithTheListOfRecentFiles) {
  Thumbnails thumbnails(folder_ / "thumbnails");
  for (const char* file : {"a.vtp", "b.vtp", "c.vtp"}) thumbnails.keep(file, picture_);
  thumbnails.keep_only({"b.vtp"});
  Thumbnails again(folder_ / "thumbnails");
  EXPECT_EQ(again.texture("a.vtp"), 0u);
  EXPECT_NE(again.texture("b.vtp"), 0u);
  EXPECT_EQ(again.texture("c.vtp"), 0u);
}

TEST_F(ThumbnailsOnDisk, WhatIsNoPictureIsNone) {
  Thumbnails thumbnails(folder_ / "thumbnails");
  thumbnails.keep("a.vtp", picture_);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "thumbnails")) fs::resize_file(entry, 20);
  Thumbnails again(folder_ / "thumbnails");
  EXPECT_EQ(again.texture("a.vtp"), 0u);
  Thumbnails nowhere(fs::path("/proc/nowhere"));
  EXPECT_NO_THROW(nowhere.keep("a.vtp", picture_));
  EXPECT_EQ(nowhere.texture("a.vtp"), 0u);
}

}  // namespace
}  // namespace nacre
