// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <crisp/pipeline.hpp>

namespace crisp::batch {

/// The inputs of a batch's results besides its recordings: crisp's version, the seed, the rig,
/// every stage with its effective options and what feeds it, and the content of the files that options name.
nlohmann::ordered_json effective_settings(const LoadedPipeline& loaded, std::uint64_t seed);

/// The first 16 of the 64 hexadecimal digits of their SHA-256.
std::string digest_of_settings(const nlohmann::ordered_json& settings);

/// The differences, each as "calibrate.rqe.sigma: 0.02 → 0.05"; the first few of many.
std::vector<std::string> changes_of_settings(const nlohmann::ordered_json& before,
                                             const nlohmann::ordered_json& now);

/// Refuses a pipeline that would do the same with every recording, or write a file that the next one
/// overwrites.
/// @param one    the pipeline as it is loaded for a recording
/// @param other  and for another one
/// @throws Errors
void check_depends_on_recording(const LoadedPipeline& one, const LoadedPipeline& other);

}  // namespace crisp::batch
