// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <crisp/calibration.hpp>
#include <crisp/error.hpp>

namespace crisp {

/// Reads a calibration's file. Keys of an earlier release are accepted.
/// @param judge  validates the terms (see catalogue.hpp); none: any term with any parameters will do
/// @param warn   receives a warning for each key of an earlier release
/// @throws Error   if the file cannot be read
/// @throws Errors  all that is wrong in it, with file:line:column
Calibration read_calibration(const std::filesystem::path& file, const JudgeTerm& judge = {},
                             const std::function<void(const Error& warning)>& warn = {});

/// The calibration as YAML. Numbers are printed so that reading them back gives the same doubles.
/// @throws Error  if a number is not finite, or the covariance does not fit its order
std::string to_yaml(const Calibration& calibration);

/// Writes it as AtomicFile does. @throws Error as to_yaml, or naming the file
void write_calibration(const std::filesystem::path& file, const Calibration& calibration);

}  // namespace crisp
