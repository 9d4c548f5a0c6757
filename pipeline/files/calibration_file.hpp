// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/data/calibration.hpp"
#include "pipeline/files/renamed_names.hpp"
#include "pipeline/files/yaml.hpp"

namespace crisp {

/// Reads a calibration.
/// @param judge  none: any term with any parameters will do
/// @throws Errors  all that is wrong, with file:line:column
Calibration parse_calibration(const YamlNode& root, const JudgeTerm& judge = {});

/// Reads the file and parses it. Keys of an earlier release are accepted.
/// @param warn  receives a warning for each such key
/// @throws Error if it cannot be read; Errors as parse_calibration
Calibration read_calibration(const std::filesystem::path& file, const JudgeTerm& judge = {},
                             const OldNameSink& warn = {});

/// The calibration as YAML. Numbers are printed so that reading them back gives the same doubles.
/// @throws Error  if a number is not finite, or the covariance does not fit its order
std::string to_yaml(const Calibration& calibration);

/// Writes it as AtomicFile does. @throws Error as to_yaml, or naming the file
void write_calibration(const std::filesystem::path& file, const Calibration& calibration);

}  // namespace crisp
