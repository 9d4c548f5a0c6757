// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "pipeline/data/error.hpp"

namespace crisp {

/// Runs an action and hands each Error that it throws to `report`.
template <class Action, class Report>
void for_each_error(Action&& action, Report&& report) {
  try {
    action();
  } catch (const Errors& several) {
    for (const auto& error : several.all()) report(error);
  } catch (const Error& error) {
    report(error);
  }
}

/// Errors that are reported together.
class AllErrors {
 public:
  /// Does something, and keeps each Error that it throws.
  template <class Action>
  void keep_of(Action&& action) {
    for_each_error(action, [&](const Error& error) { add(error); });
  }
  void add(Error error) { errors_.push_back(std::move(error)); }
  /// @throws Errors  all that were kept, if there are any
  void throw_any() {
    if (!errors_.empty()) throw Errors(std::move(errors_));
  }

 private:
  std::vector<Error> errors_;
};

/// Runs independent checks and throws all their errors together, so that people see all mistakes at once.
/// @throws Errors  all that any of them threw
template <class... Checks>
void check_all(Checks&&... checks) {
  AllErrors errors;
  (errors.keep_of(checks), ...);
  errors.throw_any();
}

}  // namespace crisp
