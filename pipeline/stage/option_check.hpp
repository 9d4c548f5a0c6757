// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>

#include "pipeline/data/all_errors.hpp"

namespace crisp {

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
