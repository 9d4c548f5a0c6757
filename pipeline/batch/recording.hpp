// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace crisp {

/// What a batch processes by one job: a file, or a folder of captures of one scanner.
struct BatchInput {
  std::string name;             ///< the relative path without its ending: where its results lie
  std::string path;             ///< absolute
  bool is_folder = false;       ///< of captures of one scanner
  std::string unreadable = {};  ///< why it cannot be read; empty where nothing is known against it
};

/// What of a folder is one recording.
enum class BatchUnit { file, folder };

/// Where a batch looks for recordings.
struct BatchInputs {
  /// Each a file, a folder, a pattern ("captures/**/*.pcap"), a list of them (NAME.txt), or "-" for a list on
  /// the standard input.
  std::vector<std::string> given;
  BatchUnit unit = BatchUnit::file;
  /// What names are relative to; empty: the given folder, what of a pattern has no wildcard, a list's folder,
  /// a file's own.
  std::filesystem::path base = {};
  std::filesystem::path output;         ///< the results, which are no inputs
  std::vector<std::string> extensions;  ///< of recordings in a folder: ".pcap"
};

/// The recordings by their names.
/// @throws Errors  what was given and is not there, and inputs that would share an output
std::vector<BatchInput> find_recordings(const BatchInputs& inputs);

}  // namespace crisp
