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

namespace crisp::batch {

/// An input whose time changed and whose content did not.
struct TouchedInput {
  std::string name;  ///< of the recording
  std::vector<InputFile> files;
};

/// The recordings to process, with reasons.
struct BatchPlan {
  std::vector<DueRecording> due;              ///< by name
  std::map<DueReason, std::size_t> reasons;   ///< how many are due for which reason
  std::map<DueReason, std::string> examples;  ///< the first of each
  std::map<JobStatus, std::size_t> kept;      ///< how many are not due, by how they ended
  std::vector<TouchedInput> touched;
};

/// The rig of a recording alone; empty where it has none.
using RigOfRecording = std::function<std::filesystem::path(const BatchInput& input)>;

/// Compares the recordings with the manifests' records. Compares each input's size and time, and reads inputs
/// of which only the time changed.
/// @param settings  digest of the settings of this batch
BatchPlan plan_batch(std::vector<BatchInput> inputs, const BatchLedger& ledger, const std::string& settings,
                     const RigOfRecording& rig_of);

/// Why recordings are due, in words: "the input changed".
std::string in_words(DueReason reason);

}  // namespace crisp::batch
