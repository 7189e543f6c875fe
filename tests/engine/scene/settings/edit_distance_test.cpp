// Nacre: tests of how far words are apart.
#include "engine/scene/settings/edit_distance.hpp"

#include <gtest/gtest.h>

#include <string>

namespace nacre {
namespace {

TEST(EditDistance, CountsLettersPutInTakenOutAndExchanged) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("torus", "torus"), 0u);
  EXPECT_EQ(edit_distance("", "train"), 5u);
  EXPECT_EQ(edit_distance("trso", "torso"), 1u);
  EXPECT_EQ(edit_distance("torso", "torus"), 2u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("trian", "train"), 2u);
}

TEST(EditDistance, LooksAtTheBeginningOfLongWords) {
  EXPECT_EQ(edit_distance(std::string(100000, 'a'), std::string(100000, 'b')), 64u);
}

}  // namespace
}  // namespace nacre
