// Nacre: the window of the keyframes among the others: its files, and what the loop is to do.
#include "app/viewer/panel/ui.hpp"

namespace nacre {

namespace fs = std::filesystem;

void Ui::ask_recording() {
  dialog_.open(FileDialog::Mode::open, "edit a recording", {".json"});
  then_ = [](const std::vector<fs::path>& files, Session&, UiRequests& requests) {
    requests.edit_recording = files.front();
  };
}

void Ui::save_keyframes() {
  if (!keyframes_.can_save()) return show_note("there are no keyframes to save");
  ask_save("save keyframes", {".json"}, keyframes_.file().empty() ? "keyframes.json" : keyframes_.file(),
           &UiRequests::save_keyframes);
}

void Ui::keyframes_window(Session& session, const UiFacts& facts, const FreeArea& area, UiRequests& requests) {
  const KeyframesWindow::Wish wish =
      keyframes_.draw(session, area, {facts.keyframes_time, facts.films_keyframes, facts.recording});
  requests.play_keyframes = wish.play;
  requests.stop_keyframes = wish.stop;
  requests.take_recording = wish.take_recording;
  if (wish.open) ask_recording();
  if (wish.save) save_keyframes();
  if (wish.film)
    ask_save("save video of the keyframes", {".mp4", ".mkv", ".mov", ".webm", ".gif"}, "keyframes.mp4",
             &UiRequests::film_keyframes);
  if (!wish.screenshot) return;
  dialog_.open(FileDialog::Mode::save, "a screenshot at this time", {".png"}, "keyframe.png");
  then_ = [this](const std::vector<fs::path>& files, Session&, UiRequests&) {
    keyframes_.add_screenshot({files.front(), 1, false, false});
  };
}

}  // namespace nacre
