// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace crisp::batch {

/// Input of one job: a file, or a folder of captures of one scanner.
struct BatchInput {
  std::string name;             ///< the relative path without its ending: where its results lie
  std::string path;             ///< absolute
  bool is_folder = false;       ///< of captures of one scanner
  std::string unreadable = {};  ///< why it cannot be read; empty where nothing is known against it
};

/// The unit of recordings in a folder.
enum class BatchUnit { file, folder };

/// Files and folders in which a batch finds recordings.
struct BatchInputs {
  /// Each a file, a folder, a pattern ("captures/**/*.pcap"), a list of them (NAME.txt), or "-" for a list on
  /// the standard input.
  std::vector<std::string> given;
  BatchUnit unit = BatchUnit::file;
  /// Base of relative names; empty: the given folder, the part of a pattern before its wildcard, a list's
  /// folder, a file's own.
  std::filesystem::path base = {};
  std::filesystem::path output;         ///< the results, which are no inputs
  std::vector<std::string> extensions;  ///< of recordings in a folder: ".pcap"
};

/// The recordings by their names.
/// @throws Errors  what was given and is not there, and inputs that would share an output
std::vector<BatchInput> find_recordings(const BatchInputs& inputs);

}  // namespace crisp::batch
