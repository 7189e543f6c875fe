// Nacre: tests of session files: what is written is read again, and what means nothing is refused.
#include "engine/scene/session/session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

using nlohmann::json;

class SessionFile : public testing::Test {
 protected:
  Session read(const std::string& text) const {
    std::ofstream(folder / "s.json") << text;
    return read_session(folder / "s.json");
  }

  /// What is said about a session that is refused.
  std::string refused(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& error) {
      return error.what();
    }
    ADD_FAILURE() << "accepted: " << text;
    return "";
  }

  std::string refused_event(const std::string& event) const { return refused(R"({"events": [)" + event + "]}"); }

  void expect_refused(const std::string& text, const std::vector<std::string>& parts) const {
    const std::string said = refused(text);
    for (const std::string& part : parts) EXPECT_NE(said.find(part), said.npos) << part << "\n" << said;
  }

  test::TemporaryFolder folder;
};

TEST_F(SessionFile, ACameraFileIsBesideTheSession) {
  const Session session =
      read(R"({"knobs": {"camera": "c.json"}, "events": [{"time": 1, "knobs": {"camera": "/d.json"}},
                                                         {"time": 2, "knobs": {"camera": "e.json"}},
                                                         {"time": 3, "knobs": {"camera": "+x"}}]})");
  EXPECT_EQ(session.settings.camera, folder / "c.json");
  EXPECT_EQ(session.events[0].knobs.at("camera"), "/d.json");
  EXPECT_EQ(session.events[1].knobs.at("camera"), folder / "e.json");
  EXPECT_EQ(session.events[2].knobs.at("camera"), "+x");
  Session written;
  written.settings.camera = "c.json";
  EXPECT_EQ(json::parse(session_text(written))["knobs"]["camera"], std::filesystem::absolute("c.json").string());
  written.settings.camera = "iso";
  EXPECT_EQ(json::parse(session_text(written))["knobs"]["camera"], "iso");
}

TEST_F(SessionFile, NamesThatJsonCannotHoldAreNamed) {
  Session session;
  session.inputs = {"/data/caf\xe9.vtp"};  // Latin-1
  EXPECT_THROW(session_text(session), Error);
}

/// A camera whose numbers have no short decimal form.
Camera odd_camera() {
  return {{1.0 / 3, -std::sqrt(2.0), 1e-17}, {0.1, 1e21, -0.3}, {0, 1.0 / 7, 1}, std::exp(1.0), true};
}

/// Every field differs from its default.
Session full_session() {
  Session session;
  session.inputs = {"/data/a.vtp", "/data/b b.vtp"};
  session.camera = odd_camera();
  session.settings.flow.ttl = 7;
  session.settings.flow.contrast = 1.0 / 3;
  session.settings.flow.seed = 4294967295u;
  session.settings.vectors = "wall \"shear\"";
  session.settings.view.hidden = "1,2";
  session.settings.view.panel = false;
  SessionEvent opens;
  opens.time = 0.1 + 0.2;
  opens.input = SessionInput{{}, "torus", 64};
  SessionEvent turns;
  turns.time = 2;
  turns.knobs = {{"contrast", "0.1"}, {"play", "false"}, {"ttl", "3"}, {"vectors", "@swirl"}};
  turns.camera = odd_camera();
  turns.over = 1.5;
  SessionEvent shoots;
  shoots.time = 4;
  shoots.screenshot = Screenshot{"/pictures/a.png", 3, false, true};
  session.events = {opens, turns, shoots};
  session.duration = 12.5;
  return session;
}

/// All knobs with values that are not the defaults.
Settings other_settings() {
  Settings settings;
  for (const Knob& knob : knobs(settings)) {
    const double between = knob.min + (knob.max - knob.min) / 3;
    if (std::holds_alternative<bool*>(knob.value))
      set_knob(settings, knob.name, knob.text() == "true" ? "false" : "true");
    else if (std::holds_alternative<double*>(knob.value))
      **std::get_if<double*>(&knob.value) = between;
    else if (!knob.choices.empty())
      set_knob(settings, knob.name, knob.choices.back());
    else if (std::holds_alternative<std::string*>(knob.value))
      set_knob(settings, knob.name,
               knob.name == "names" || knob.name == "size_image" || knob.name == "compare"
                   ? "/data/other"
                   : "other");  // a file, whose name becomes whole
    else
      set_knob(settings, knob.name, std::to_string(std::int64_t(between)));
  }
  return settings;
}

TEST_F(SessionFile, EveryFieldComesBack) {
  const Session session = full_session();
  const Session back = read(session_text(session));
  EXPECT_EQ(static_cast<const SessionInput&>(back), static_cast<const SessionInput&>(session));
  EXPECT_EQ(back.camera, session.camera);
  EXPECT_EQ(knob_values(back.settings), knob_values(session.settings));
  EXPECT_EQ(back.duration, session.duration);
  ASSERT_EQ(back.events.size(), session.events.size());
  for (std::size_t k = 0; k < session.events.size(); ++k) {
    EXPECT_EQ(back.events[k].time, session.events[k].time);
    EXPECT_EQ(back.events[k].input, session.events[k].input);
    EXPECT_EQ(back.events[k].knobs, session.events[k].knobs);
    EXPECT_EQ(back.events[k].camera, session.events[k].camera);
    EXPECT_EQ(back.events[k].over, session.events[k].over);
    EXPECT_EQ(back.events[k].screenshot, session.events[k].screenshot);
  }
}

TEST_F(SessionFile, TextComesBack) {
  const std::string text = session_text(full_session());
  EXPECT_EQ(session_text(read(text)), text);
}

TEST_F(SessionFile, EveryKnobComesBackInTheStateAndInEvents) {
  Session before, after;
  after.settings = other_settings();
  EXPECT_EQ(knob_values(read(session_text(after)).settings), knob_values(after.settings));
  const std::optional<SessionEvent> change = session_change(before, after);
  ASSERT_TRUE(change);
  before.events = {*change};
  Session back = read(session_text(before));
  ASSERT_EQ(back.events.size(), 1u);
  Settings defaults;
  EXPECT_GE(back.events[0].knobs.size() + 5, knobs(defaults).size());  // a third of the range may be the default
  apply_event(back.events[0], back);
  EXPECT_EQ(knob_values(back.settings), knob_values(after.settings));
}

TEST_F(SessionFile, MostMayBeLeftOut) {
  const Session session = read("{}");
  EXPECT_TRUE(session.inputs.empty() && session.sample.empty() && !session.camera && session.events.empty());
  EXPECT_EQ(knob_values(session.settings), knob_values(Settings()));
}

TEST_F(SessionFile, RelativeFilesAreBesideIt) {
  const Session session = read(R"({"inputs": ["a.vtp", "/b.vtp"], "events": [
    {"time": 1, "inputs": ["sub/c.vtp"]}, {"time": 2, "screenshot": {"file": "d.png"}}]})");
  EXPECT_EQ(session.inputs[0], folder / "a.vtp");
  EXPECT_EQ(session.inputs[1], "/b.vtp");
  EXPECT_EQ(session.events[0].input->inputs[0], folder / "sub/c.vtp");
  EXPECT_EQ(session.events[1].screenshot->file, folder / "d.png");
}

TEST_F(SessionFile, EventsAreSortedAndThoseOfOneTimeKeepTheirOrder) {
  const Session session = read(R"({"events": [{"time": 3}, {"time": 1, "knobs": {"ttl": 2}},
    {"time": 2}, {"time": 1, "knobs": {"ttl": 3}}]})");
  ASSERT_EQ(session.events.size(), 4u);
  EXPECT_EQ(session.events[0].knobs.at("ttl"), "2");
  EXPECT_EQ(session.events[1].knobs.at("ttl"), "3");
  EXPECT_EQ(session.events[3].time, 3);
  EXPECT_EQ(session.duration, 3);
}

TEST_F(SessionFile, DurationReachesTheEndOfTheLastCamera) {
  const std::string camera = R"("camera": {"eye": [1, 0, 0], "target": [0, 0, 0]})";
  EXPECT_EQ(read(R"({"events": [{"time": 3, "over": 2, )" + camera + "}, {\"time\": 4}]}").duration, 5);
  EXPECT_EQ(read(R"({"duration": 9, "events": [{"time": 3}]})").duration, 9);
}

TEST_F(SessionFile, NamesWithDashesAreTheTables) {
  const Session session =
      read(R"({"knobs": {"step-cells": 5}, "events": [{"time": 1, "knobs": {"step-cells": "6.50"}}]})");
  EXPECT_EQ(session.settings.flow.step_cells, 5);
  EXPECT_EQ(session.events[0].knobs, (std::map<std::string, std::string>{{"step_cells", "6.5"}}));
  EXPECT_EQ(session_text(read(session_text(session))), session_text(session));
}

TEST_F(SessionFile, OldNamesOfKnobsAreRead) {
  const Session session = read(R"({"knobs": {"crease": 30}, "events": [{"time": 1, "knobs": {"crease": 50}}]})");
  EXPECT_EQ(session.settings.crease_angle, 30);
  EXPECT_EQ(session.events[0].knobs, (std::map<std::string, std::string>{{"crease_angle", "50"}}));
  const json written = json::parse(session_text(session));
  EXPECT_EQ(written["knobs"]["crease_angle"], 30);
  EXPECT_FALSE(written["knobs"].contains("crease"));
}

TEST_F(SessionFile, WhatMeansNothingIsRefused) {
  expect_refused(R"({"input": ["a"]})", {"'input' is not valid in a session", "inputs"});
  expect_refused(R"({"events": [{"time": 1}, {"tme": 1}]})", {"event 2", "'tme' is not valid in an event"});
  expect_refused(R"({"knobs": {"tttl": 3}})", {"no knob 'tttl'", "ttl"});
  expect_refused(R"({"camera": {"eye": [1, 0, 0], "target": [0, 0, 0], "ortho": true}})", {"'ortho'", "a camera"});
  EXPECT_NE(refused_event(R"({"time": 1, "knobs": {"tttl": 3}})").find("event 1"), std::string::npos);
  EXPECT_NE(refused_event(R"({"time": 1, "screenshot": {"file": "a.png", "size": 2}})").find("'size'"),
            std::string::npos);
  expect_refused(R"({"nacre": "session 2"})", {"session 2", "session 1"});
  expect_refused(R"({"nacre": "0.9.0", "command": "flow"})", {"is not a session"});
}

TEST_F(SessionFile, WrongTypesAreRefused) {
  for (const char* text : {"",
                           "[]",
                           "7",
                           "{",
                           R"({"knobs": []})",
                           R"({"knobs": {"ttl": null}})",
                           R"({"knobs": {"ttl": 2.5}})",
                           R"({"knobs": {"ttl": "many"}})",
                           R"({"knobs": {"play": 3}})",
                           R"({"sample": 3})",
                           R"({"detail": 2.5})",
                           R"({"detail": -1})",
                           R"({"detail": 10000000000})",
                           R"({"inputs": [3]})",
                           R"({"events": {}})",
                           R"({"events": [3]})",
                           R"({"camera": [1, 2, 3]})",
                           R"({"camera": {"eye": [1, 2], "target": [0, 0, 0]}})",
                           R"({"duration": "long"})",
                           R"({"duration": -1})",
                           R"({"duration": 1e7})",
                           R"({"nacre": 1})",
                           R"({"sample": "torus", "inputs": ["a.vtp"]})"})
    EXPECT_NE(refused(text).find("is not a session"), std::string::npos) << text;
}

TEST_F(SessionFile, ValuesOutOfRangeAreRefused) {
  expect_refused(R"({"knobs": {"ttl": 17}})", {"--ttl", "1..16"});
  expect_refused(R"({"knobs": {"contrast": 1e999}})", {"is not a session"});
  expect_refused(R"({"knobs": {"method": "sieve"}})", {"method", "grid|octree"});
  expect_refused(R"({"camera": {"eye": [0, 0, 0], "target": [0, 0, 0]}})", {"camera", "differ"});
}

TEST_F(SessionFile, EventsThatCannotBeAreRefused) {
  const std::string camera = R"("camera": {"eye": [1, 0, 0], "target": [0, 0, 0]})";
  for (const std::string& event :
       {std::string(R"({"knobs": {"ttl": 3}})"), std::string(R"({"time": -0.1})"), std::string(R"({"time": 1e7})"),
        std::string(R"({"time": "1"})"), std::string(R"({"time": 1, "over": 2})"),
        R"({"time": 1, "over": -2, )" + camera + "}", std::string(R"({"time": 1, "knobs": {"ttl": 99}})"),
        std::string(R"({"time": 1, "detail": 64})"), std::string(R"({"time": 1, "inputs": []})"),
        std::string(R"({"time": 1, "screenshot": {"scale": 2}})"),
        std::string(R"({"time": 1, "screenshot": {"file": "a.png", "scale": 5}})"),
        std::string(R"({"time": 1, "screenshot": {"file": "a.png", "scale": 0}})")})
    EXPECT_NE(refused_event(event).find("event 1: "), std::string::npos) << event;
}

TEST_F(SessionFile, AMissingFileIsNamed) {
  EXPECT_THROW(read_session(folder / "nosuch.json"), Error);
  EXPECT_THROW(read_session(folder.path()), Error);
}

TEST(SessionChange, IsWhatDiffers) {
  Session before, after;
  EXPECT_FALSE(session_change(before, after));
  after.settings.flow.ttl = 9;
  after.camera = odd_camera();
  after.sample = "torus";
  const std::optional<SessionEvent> change = session_change(before, after);
  ASSERT_TRUE(change);
  EXPECT_EQ(change->knobs, (std::map<std::string, std::string>{{"ttl", "9"}}));
  EXPECT_EQ(change->input->sample, "torus");
  apply_event(*change, before);
  EXPECT_FALSE(session_change(before, after));
  EXPECT_EQ(session_text(before), session_text(after));
}

TEST(SessionChange, WhatIsOpenedHasItsCameraFitted) {
  Session session;
  session.camera = odd_camera();
  SessionEvent event;
  event.knobs = {{"ttl", "3"}};
  apply_event(event, session);
  EXPECT_TRUE(session.camera);
  event.knobs = {{"camera", "+x"}};
  apply_event(event, session);
  EXPECT_FALSE(session.camera);
  session.camera = odd_camera();
  event = {};
  event.input = SessionInput{{}, "torus", 0};
  EXPECT_TRUE(fits_camera(event));
  apply_event(event, session);
  EXPECT_FALSE(session.camera);
  event.camera = odd_camera();
  EXPECT_FALSE(fits_camera(event));
  apply_event(event, session);
  EXPECT_EQ(session.camera, odd_camera());
}

}  // namespace
}  // namespace nacre
