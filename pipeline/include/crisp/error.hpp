// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace crisp {

/// A place in a file that a person wrote. Lines and columns start at 1; 0 means "not known".
struct Place {
  std::string file;  ///< as the user named it; empty: not known
  int line = 0;      ///< from 1
  int column = 0;    ///< from 1, in bytes
};

/// "file:line:column", as much of it as is known.
std::string to_string(const Place& place);

/// The one exception of crisp: what is wrong, where, and what to do about it. Damaged input is no Error but a
/// counted loss; an Error means that the requested job cannot be done.
class Error : public std::runtime_error {
 public:
  /// @param what    what happened, with number and unit
  /// @param advice  what the user changes; may be empty
  /// @param place   where in a file of the user's
  explicit Error(std::string what, std::string advice = {}, Place place = {});

  const std::string& message() const { return message_; }  ///< what happened
  const std::string& advice() const { return advice_; }    ///< what the user changes; empty: none
  const Place& place() const { return place_; }            ///< in a file of the user's

  /// The same, and that it is an option of a stage that is wrong, whose place the pipeline knows.
  Error of_option(std::string name) const;
  const std::string& option() const { return option_; }  ///< empty: none

 private:
  std::string message_;
  std::string advice_;
  Place place_;
  std::string option_;
};

/// Several errors found in one go (all mistakes of a pipeline at once).
class Errors : public Error {
 public:
  /// @param errors  at least one; what() has all of them, a line each
  explicit Errors(std::vector<Error> errors);
  const std::vector<Error>& all() const { return errors_; }  ///< each by itself, in the order of finding

 private:
  std::vector<Error> errors_;
};

/// Thrown by work that was stopped before its end.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

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
