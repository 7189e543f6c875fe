// Nacre: tests of the second view of a session: its input, its knobs, and the two views exchanged.
#include "engine/scene/session/compared.hpp"

#include <gtest/gtest.h>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

Session compared_with(const std::string& compare, const std::string& knobs = "") {
  Session session;
  session.sample = "torus";
  session.detail = 48;
  session.settings.view.compare = compare;
  session.settings.view.compare_knobs = knobs;
  return session;
}

TEST(Compared, NothingIsComparedAtFirst) { EXPECT_FALSE(compares(Session())); }

TEST(Compared, TheSameDataWithOtherKnobs) {
  const Session first = compared_with("same", "ttl=9;step-cells=2");
  ASSERT_TRUE(compares(first));
  const Session second = compared_session(first);
  EXPECT_EQ(second.sample, "torus");
  EXPECT_EQ(second.detail, 48);
  EXPECT_EQ(second.settings.flow.ttl, 9);
  EXPECT_EQ(second.settings.flow.step_cells, 2);
  EXPECT_EQ(second.settings.flow.resolution, first.settings.flow.resolution);
  EXPECT_FALSE(compares(second)) << "there are two views, not endlessly many";
}

TEST(Compared, InputsAreNamedAndNamedAgain) {
  EXPECT_EQ(compared_input(compared_with("sample:sphere")), (SessionInput{{}, "sphere", 0}));
  EXPECT_EQ(compared_input(compared_with("sample:sphere:96")), (SessionInput{{}, "sphere", 96}));
  EXPECT_EQ(compared_input(compared_with("a.vtp;b.vtp")), (SessionInput{{"a.vtp", "b.vtp"}, "", 0}));
  for (const char* text : {"sample:sphere", "sample:sphere:96", "a.vtp", "a.vtp;b.vtp"})
    EXPECT_EQ(compare_text(compared_input(compared_with(text))), text);
  EXPECT_THROW(compared_input(compared_with("sample:sphere:x")), Error);
}

TEST(Compared, FilesAreBesideTheSession) {
  EXPECT_EQ(compare_beside("/data", "a.vtp;/other/b.vtp"), "/data/a.vtp;/other/b.vtp");
  for (const char* text : {"", "same", "sample:sphere"}) EXPECT_EQ(compare_beside("/data", text), text);
}

TEST(Compared, WhatMeansNothingIsRefused) {
  for (const char* knobs : {"ttl", "=4", "ttl=many", "ttl=-1", "tlt=4", "width=100", "begin_at=0.5", "compare=same"})
    EXPECT_THROW(compared_session(compared_with("same", knobs)), Error) << knobs;
  EXPECT_NO_THROW(compared_session(compared_with("same", ";ttl=4;;edges=true;")));
}

TEST(Compared, TwiceExchangedItIsAsBefore) {
  const Session first = compared_with("sample:sphere:32", "ttl=9");
  Session session = first;
  swap_compared(session);
  EXPECT_EQ(session.sample, "sphere");
  EXPECT_EQ(session.detail, 32);
  EXPECT_EQ(session.settings.flow.ttl, 9);
  EXPECT_EQ(session.settings.view.compare, "sample:torus:48");
  const Session second = compared_session(session);
  EXPECT_EQ(second.sample, "torus");
  EXPECT_EQ(second.settings.flow.ttl, first.settings.flow.ttl);
  swap_compared(session);
  EXPECT_FALSE(session_change(first, session));
}

TEST(Compared, HeadingsSayWhatDiffers) {
  EXPECT_EQ(first_heading(compared_with("same", "ttl=9")), "ttl = 4");
  EXPECT_EQ(second_heading(compared_with("same", "ttl=9")), "ttl = 9");
  EXPECT_EQ(first_heading(compared_with("/data/a.vtp")), "torus");
  EXPECT_EQ(second_heading(compared_with("/data/a.vtp")), "a.vtp");
  EXPECT_EQ(second_heading(compared_with("/data/a.vtp", "edges=true;ttl=9")), "a.vtp,  ttl = 9,  edges = true");
  EXPECT_EQ(second_heading(compared_with("same")), "");
}

TEST(Compared, ASessionFileKeepsIt) {
  const Session first = compared_with("same", "ttl=9");
  const Session again = parse_session(session_text(first));
  EXPECT_EQ(again.settings.view.compare, "same");
  EXPECT_EQ(again.settings.view.compare_knobs, "ttl=9");
}

}  // namespace
}  // namespace nacre
