// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/internal_error.hpp"

namespace crisp::data {

Error internal_error(const std::string& what) {
  return Error(what + ": an error of this program", "please report it with the command and its input");
}

}  // namespace crisp::data
