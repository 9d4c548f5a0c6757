// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <crisp/error.hpp>

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
  /// Keeps one error.
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

/// A check for check_all() whose errors are of this option of the stage: they name the place where it was
/// set, in the pipeline's file or on the command line.
/// @throws Errors  what the check threw
template <class Check>
auto of_option(std::string option, Check check) {
  return [option = std::move(option), check = std::move(check)] {
    AllErrors errors;
    for_each_error(check, [&](const Error& error) { errors.add(error.of_option(option)); });
    errors.throw_any();
  };
}

}  // namespace crisp
