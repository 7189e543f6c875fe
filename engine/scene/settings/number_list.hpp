// Nacre: numbers in the text of a knob.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace nacre {

/// Without the blanks around it.
std::string trimmed(const std::string& text);

/// The parts between the characters `at`; one more than there are of these.
std::vector<std::string> split(const std::string& text, char at);

/// "A,B,...", with blanks or without, where all are finite numbers; else none.
std::optional<std::vector<double>> parse_numbers(const std::string& text);

}  // namespace nacre
