// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace crisp {

/// Thrown by work that was stopped before its end.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace crisp
