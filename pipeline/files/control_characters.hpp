// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace crisp::files {

/// Position of the first control character, except tabs and line breaks: nobody writes one into a text file,
/// and it could do anything to a terminal. npos if there is none.
std::size_t find_control_character(std::string_view text);

/// The fault in words: "there is a control character (0x1b)".
std::string control_character_in_words(char character);

/// The beginning of a text from a file for a message about it: what is not plain ASCII as \xNN, and … where
/// it goes on.
std::string shown(std::string_view text);

}  // namespace crisp::files
