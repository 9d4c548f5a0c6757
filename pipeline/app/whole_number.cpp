// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/whole_number.hpp"

#include <charconv>
#include <string>

namespace crisp::app {

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  const std::string range = std::to_string(least) + " to " + std::to_string(most);
  const auto refuse = [=](const std::string& text) -> std::string {
    std::uint64_t number = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure != std::errc::result_out_of_range &&
        (failure != std::errc() || end != text.data() + text.size()))
      return "'" + text + "' is not a whole number, " + range;
    if (failure == std::errc() && number >= least && number <= most) return {};
    return text + " is not from " + range;
  };
  return CLI::Validator(refuse, "", "whole_number");
}

}  // namespace crisp::app
