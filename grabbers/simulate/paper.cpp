// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/paper.hpp"

#include "grabbers/simulate/shapes.hpp"

namespace crisp::simulate {

Scene paper_room() {
  return {
      "paper's room",
      walls("wall", {{-4.1, -2.9}, {4.6, -2.9}, {4.6, 1.7}, {2.2, 1.7}, {2.2, 3.8}, {-1.5, 3.8}, {-4.1, 2.3}},
            -1, 1, 0.6)};
}

ScannerSettings paper_scanner(std::uint64_t seed) {
  ScannerSettings settings;
  settings.seed = seed;
  settings.beams = {0, 360};
  return settings;
}

}  // namespace crisp::simulate
