// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/error.hpp>

namespace crisp {

/// What an action complains of: all of its Errors, its only Error, or nothing.
template <typename Action>
std::vector<std::string> errors_of(Action&& action) {
  std::vector<std::string> all;
  try {
    action();
  } catch (const Errors& errors) {
    for (const auto& error : errors.all()) all.emplace_back(error.what());
  } catch (const Error& error) {
    all.emplace_back(error.what());
  }
  return all;
}

}  // namespace crisp
