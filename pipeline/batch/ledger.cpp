// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/ledger.hpp"

#include <algorithm>
#include <utility>

namespace crisp::batch {

BatchLedger BatchLedger::read(const std::filesystem::path& output,
                              const std::function<bool(std::string_view name)>& requested) {
  BatchLedger ledger;
  for (const auto& file : manifests_of(output)) {
    const std::string task = file.parent_path().string();
    ledger.damaged_lines_ += read_manifest(file, [&](BatchEvent&& event, std::string_view) {
      if (!event.name.empty() && (!requested || requested(event.name))) ledger.add(std::move(event), task);
    });
  }
  return ledger;
}

std::string_view BatchLedger::shared(std::string_view text) {
  const auto known = texts_.find(text);
  return known != texts_.end() ? *known : *texts_.emplace(text).first;
}

void BatchLedger::add(BatchEvent event, std::string_view task) {
  RecordingState& state = states_[event.name];
  switch (event.kind) {
    case BatchEventKind::batch:
      break;
    case BatchEventKind::start:
      if (event.time < state.started) break;
      state.started = event.time;
      state.started_by = shared(task);
      break;
    case BatchEventKind::retry:
      state.retry_requested = std::max(state.retry_requested, event.time);
      break;
    case BatchEventKind::same:
      if (event.time >= state.ended) state.input = std::move(event.input);
      break;
    case BatchEventKind::end:
      if (event.time < state.ended) break;
      state.ended = event.time;
      state.status = event.status;
      state.settings = shared(event.settings);
      state.input = std::move(event.input);
      break;
  }
}

const RecordingState* BatchLedger::find(const std::string& name) const {
  const auto found = states_.find(name);
  return found == states_.end() ? nullptr : &found->second;
}

DueReason due_reason(const RecordingState* state, const std::string& settings) {
  if (!state) return DueReason::fresh;
  if (state->is_half_done()) return DueReason::half_done;
  if (!state->has_ended()) return DueReason::fresh;
  if (state->is_retry_requested()) return DueReason::retry;
  if (state->settings != settings) return DueReason::settings;
  if (state->status == JobStatus::interrupted) return DueReason::interrupted;
  return DueReason::none;
}

}  // namespace crisp::batch
