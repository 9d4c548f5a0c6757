// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/plan.hpp"

#include <utility>

#include <crisp/error.hpp>

namespace crisp::batch {
namespace {

/// Whether the input is that of the state; adds it to `touched` if only its time is another.
bool is_same_input(const RecordingState& state, const BatchInput& input, const std::filesystem::path& rig,
                   std::vector<TouchedInput>& touched) {
  try {
    auto now = input_files(input, rig);
    if (is_untouched(state.input, now)) return true;
    if (!has_same_content(state.input, now, input, rig)) return false;
    for (std::size_t i = 0; i < now.size(); ++i) now[i].sha256 = state.input[i].sha256;
    touched.push_back({input.name, std::move(now)});
    return true;
  } catch (const Error&) {
    return state.input.empty();  // it could not be read then, and cannot now
  }
}

}  // namespace

BatchPlan plan_batch(std::vector<BatchInput> inputs, const BatchLedger& ledger, const std::string& settings,
                     const RigOfRecording& rig_of) {
  BatchPlan plan;
  for (auto& input : inputs) {
    const RecordingState* state = ledger.find(input.name);
    const auto rig = rig_of(input);
    DueReason reason = due_reason(state, settings);
    if (reason == DueReason::none && !is_same_input(*state, input, rig, plan.touched))
      reason = DueReason::input;
    if (reason == DueReason::none) {
      ++plan.kept[state->status];
      continue;
    }
    if (++plan.reasons[reason] == 1) plan.examples[reason] = input.name;
    plan.due.push_back({std::move(input), rig});
  }
  return plan;
}

std::string in_words(DueReason reason) {
  switch (reason) {
    case DueReason::fresh:
      return "they are new";
    case DueReason::half_done:
      return "the batch ended before they did";
    case DueReason::interrupted:
      return "they were stopped or killed from outside";
    case DueReason::retry:
      return "a retry was requested";
    case DueReason::settings:
      return "the settings changed";
    case DueReason::input:
      return "the input changed";
    case DueReason::none:
      break;
  }
  return "nothing changed";
}

}  // namespace crisp::batch
