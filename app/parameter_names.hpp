// Nacre: the parameters that an Error names, as options of the command line or as knobs of the viewer.
#pragma once

#include <string>

namespace nacre {

namespace detail {

/// `text` with each name in backquotes, of small letters, digits and underscores alone, replaced by put(name).
template <class Put>
std::string replace_parameters(const std::string& text, const Put& put) {
  std::string result;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end =
        text[at] == '`' ? text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_", at + 1) : std::string::npos;
    if (end == std::string::npos || text[end] != '`' || end == at + 1) {
      result += text[at++];
    } else {
      result += put(text.substr(at + 1, end - at - 1));
      at = end + 1;
    }
  }
  return result;
}

}  // namespace detail

/// "raise `min_size`" as "raise --min-size".
inline std::string with_options(const std::string& text) {
  return detail::replace_parameters(text, [](std::string name) {
    for (char& c : name)
      if (c == '_') c = '-';
    return "--" + name;
  });
}

/// "raise `min_size`" as "raise min_size", the name that a panel shows.
inline std::string with_knobs(const std::string& text) {
  return detail::replace_parameters(text, [](const std::string& name) { return name; });
}

}  // namespace nacre
