// Nacre: the card for newcomers, by mouse. No OpenGL here.
#include "app/viewer/panel/welcome_card.hpp"

#include <nlohmann/json.hpp>

#include "engine/scene/session/session.hpp"
#include "tests/app/imgui_frames.hpp"

namespace nacre::test {
namespace {

class WelcomeCardTest : public ImGuiFrames {
 protected:
  void SetUp() override {
    begin(800, 700);
    card_.show();
    for (int k = 0; k < 3; ++k) frame();
  }
  void draw() override {
    const WelcomeCard::Wish wish = card_.draw({0, 0, 800, 700}, recent_);
    if (wish.open || wish.file || !wish.sample.empty() || !wish.tour.empty()) wish_ = wish;
  }
  /// Clicks on what is in the card, from above, until `done`.
  void click_until(const std::function<bool()>& done) {
    for (float y = 150; y < 650 && !done(); y += 6)
      for (const float x : {230.f, 420.f}) {
        card_.show();
        frame();
        frame();
        click(x, y);
        if (done()) return;
      }
  }

  std::vector<RecentFile> recent_{{"/data/wing.vtp", 0}};
  WelcomeCard card_;
  WelcomeCard::Wish wish_;
};

TEST_F(WelcomeCardTest, EveryChoiceHidesIt) {
  click_until([&] { return wish_.open; });
  EXPECT_TRUE(wish_.open);
  EXPECT_FALSE(card_.is_shown());
  click_until([&] { return wish_.file.has_value(); });
  EXPECT_EQ(wish_.file, recent_[0].file);
  click_until([&] { return !wish_.sample.empty(); });
  EXPECT_NE(wish_.sample, "");
}

TEST_F(WelcomeCardTest, ToursAreRecordingsOfSamples) {
  std::vector<std::string> tours;
  for (float y = 150; y < 650; y += 6)
    for (const float x : {230.f, 420.f}) {
      wish_ = {};
      card_.show();
      frame();
      frame();
      click(x, y);
      if (!wish_.tour.empty() && (tours.empty() || tours.back() != wish_.tour)) tours.push_back(wish_.tour);
    }
  ASSERT_GE(tours.size(), 2u);
  for (const std::string& text : tours) {
    const Session session = parse_session(text);
    EXPECT_NE(session.sample, "");
    EXPECT_FALSE(session.events.empty());
  }
}

TEST_F(WelcomeCardTest, NothingIsWishedWhileItIsHidden) {
  card_.hide();
  for (float y = 100; y < 650; y += 12) click(230, y);
  EXPECT_FALSE(wish_.open || wish_.file || !wish_.sample.empty() || !wish_.tour.empty());
}

}  // namespace
}  // namespace nacre::test
