// Nacre: a user's input, frame by frame.
#include "engine/gl/input_queue.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace nacre::test {
namespace {

void tap(InputQueue& queue, int key) {
  queue.add(KeyMoved{key, true});
  queue.add(KeyMoved{key, false});
}

/// Frames until nothing more comes, `most` at most.
std::vector<InputFrame> frames(InputQueue& queue, int most = 40) {
  std::vector<InputFrame> all;
  for (int k = 0; k < most; ++k) all.push_back(queue.next_frame());
  return all;
}

TEST(InputQueue, ATapIsSeenDownAndThenUp) {
  InputQueue queue;
  tap(queue, GLFW_KEY_ENTER);
  EXPECT_EQ(queue.next_frame().keys, (std::map<int, bool>{{GLFW_KEY_ENTER, true}}));
  EXPECT_EQ(queue.next_frame().keys, (std::map<int, bool>{{GLFW_KEY_ENTER, false}}));
  EXPECT_TRUE(queue.next_frame().keys.empty());
}

TEST(InputQueue, AClickIsWhereTheMouseWas) {
  InputQueue queue;
  queue.add(MouseMoved{10, 20});
  queue.add(ButtonMoved{0, true});
  queue.add(ButtonMoved{0, false});
  queue.add(MouseMoved{300, 400});
  const InputFrame down = queue.next_frame(), up = queue.next_frame(), away = queue.next_frame();
  EXPECT_EQ(down.buttons, (std::map<int, bool>{{0, true}}));
  EXPECT_EQ(down.x, 10);
  EXPECT_EQ(up.buttons, (std::map<int, bool>{{0, false}}));
  EXPECT_EQ(up.y, 20);
  EXPECT_EQ(away.x, 300);
}

TEST(InputQueue, MovesOfAFrameAreOne) {
  InputQueue queue;
  for (int k = 1; k <= 9; ++k) queue.add(MouseMoved{double(k), 0});
  EXPECT_EQ(queue.next_frame().x, 9);
}

TEST(InputQueue, CtrlIsHeldWhileItsClickIsSeen) {
  InputQueue queue;
  queue.add(KeyMoved{GLFW_KEY_LEFT_CONTROL, true});
  queue.add(ButtonMoved{0, true});
  queue.add(ButtonMoved{0, false});
  queue.add(KeyMoved{GLFW_KEY_LEFT_CONTROL, false});
  const InputFrame down = queue.next_frame();
  EXPECT_TRUE(down.keys.at(GLFW_KEY_LEFT_CONTROL));
  EXPECT_TRUE(down.buttons.at(0));
  EXPECT_TRUE(queue.next_frame().keys.empty());  // the button is up, the key still down
  EXPECT_FALSE(queue.next_frame().keys.at(GLFW_KEY_LEFT_CONTROL));
}

TEST(InputQueue, AChordIsNamedAndWhatFollowsWaitsForWhatItOpens) {
  InputQueue queue;
  queue.add(KeyMoved{GLFW_KEY_LEFT_CONTROL, true});
  queue.add(KeyMoved{GLFW_KEY_LEFT_SHIFT, true});
  tap(queue, GLFW_KEY_Z);
  queue.add(KeyMoved{GLFW_KEY_LEFT_SHIFT, false});
  queue.add(KeyMoved{GLFW_KEY_LEFT_CONTROL, false});
  tap(queue, GLFW_KEY_A);
  queue.add(TextTyped{U'a'});
  const std::vector<InputFrame> all = frames(queue);
  ASSERT_EQ(all[0].chords.size(), 1u);
  EXPECT_EQ(all[0].chords[0].key, 'Z');
  EXPECT_TRUE(all[0].chords[0].ctrl && all[0].chords[0].shift);
  EXPECT_TRUE(all[1].keys.empty() && all[2].keys.empty());
  std::size_t chords = 0;
  std::u32string text;
  for (const InputFrame& frame : all) chords += frame.chords.size(), text += frame.text;
  EXPECT_EQ(chords, 1u);  // the letter after it is none
  EXPECT_EQ(text, U"a");
}

TEST(InputQueue, EscapeIsAChordOfItsOwn) {
  InputQueue queue;
  tap(queue, GLFW_KEY_ESCAPE);
  const InputFrame frame = queue.next_frame();
  ASSERT_EQ(frame.chords.size(), 1u);
  EXPECT_EQ(frame.chords[0].key, 27);
  EXPECT_FALSE(frame.chords[0].ctrl);
}

TEST(InputQueue, LettersKeepTheirOrderWithKeys) {
  InputQueue queue;
  for (const char32_t letter : std::u32string(U"ttl")) {
    queue.add(KeyMoved{'A', true});
    queue.add(TextTyped{letter});
    queue.add(KeyMoved{'A', false});
  }
  tap(queue, GLFW_KEY_BACKSPACE);
  queue.add(TextTyped{U'x'});
  std::u32string text;
  for (const InputFrame& frame : frames(queue)) {
    text += frame.text;
    if (frame.keys.count(GLFW_KEY_BACKSPACE) && frame.keys.at(GLFW_KEY_BACKSPACE)) text.pop_back();
  }
  EXPECT_EQ(text, U"ttx");
}

TEST(InputQueue, WhatIsTypedAfterAClickComesAfterIt) {
  InputQueue queue;
  queue.add(ButtonMoved{0, true});
  queue.add(TextTyped{U'6'});
  EXPECT_EQ(queue.next_frame().text, U"");
  EXPECT_EQ(queue.next_frame().text, U"6");
}

TEST(InputQueue, AWheelTurnsAsFarAsItWasTurned) {
  InputQueue queue;
  queue.add(WheelTurned{0, 1});
  queue.add(WheelTurned{0, 2});
  EXPECT_EQ(queue.next_frame().wheel_y, 3);
  EXPECT_EQ(queue.next_frame().wheel_y, 0);
}

}  // namespace
}  // namespace nacre::test
