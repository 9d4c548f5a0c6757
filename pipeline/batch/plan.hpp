// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pipeline/batch/ledger.hpp"
#include "pipeline/batch/run_batch.hpp"

namespace crisp {

/// An input whose time changed and whose content did not.
struct TouchedInput {
  std::string name;  ///< of the recording
  std::vector<InputFile> files;
};

/// What of the recordings is to be processed, and why.
struct BatchPlan {
  std::vector<DueRecording> due;              ///< by name
  std::map<DueReason, std::size_t> reasons;   ///< how many are due for which reason
  std::map<DueReason, std::string> examples;  ///< the first of each
  std::map<JobStatus, std::size_t> kept;      ///< how many are not due, by how they ended
  std::vector<TouchedInput> touched;
};

/// The rig of a recording alone; empty where it has none.
using RigOfRecording = std::function<std::filesystem::path(const BatchInput& input)>;

/// Compares the recordings with what the manifests say was done. Looks at each input's size and time, and
/// reads those of which only the time changed.
/// @param settings  digest of what they would be processed with
BatchPlan plan_batch(std::vector<BatchInput> inputs, const BatchLedger& ledger, const std::string& settings,
                     const RigOfRecording& rig_of);

/// Why recordings are due, in words: "the input changed".
std::string in_words(DueReason reason);

}  // namespace crisp
