// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace crisp::test {

enum class Command : std::uint8_t { run, batch, record };

/// One way to run the program on a small input.
struct Scenario {
  std::string name;
  std::string pipeline;              ///< file below configs/, or the text of a pipeline; not of record
  std::string input;                 ///< file in the folder of inputs, or a folder there; "": none
  std::vector<std::string> set;      ///< for --set
  std::vector<std::string> earlier;  ///< further --set of the earlier run into the same folder
  std::string grows;                 ///< file that is written in place, behind what is there
  Command command = Command::run;
};

const std::vector<Scenario>& scenarios();

/// Settings of grabber.simulate.
const std::vector<std::string>& small_recording();

}  // namespace crisp::test
