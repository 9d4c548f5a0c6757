// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/stage_worker.hpp"

#include <algorithm>

namespace crisp::stage {
namespace {

void add_items(const Kind& kind, std::uint64_t n, std::map<std::string, std::uint64_t>& items) {
  if (n > 0) items[std::string(kind.name())] += n;
}

}  // namespace

StageWorker::StageWorker(PipelineNode& stage) : node(&stage) {
  result.tag = stage.tag;
  result.stage = type().name;
  taken.resize(type().inputs.size());
  given.resize(type().outputs.size());
  for (std::size_t i = 0; i < type().inputs.size(); ++i) {
    slots.push_back({type().inputs[i].kind, nullptr});
    open.push_back(stage.feeders[i].size());
  }
}

bool StageWorker::is_ready() const {
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const StageInput& input = type().inputs[i];
    if (input.held && !slots[i].value && (input.required || open[i] > 0)) return false;
  }
  return true;
}

void StageWorker::count_given(const Item& item) {
  const auto& outputs = type().outputs;
  const auto output = std::ranges::find(outputs, item.kind);
  if (output == outputs.end()) {
    throw Error("it gives " + std::string(item.kind.name()) + ", which it does not declare",
                "let the stage's describe() declare it by gives()");
  }
  if (!item.value)
    throw Error("it gives a " + std::string(item.kind.name()) + " that is null",
                "let the stage give an item, or nothing");
  ++given[static_cast<std::size_t>(output - outputs.begin())];
}

NodeResult StageWorker::take_result() {
  for (std::size_t i = 0; i < taken.size(); ++i) add_items(type().inputs[i].kind, taken[i], result.taken);
  for (std::size_t i = 0; i < given.size(); ++i) add_items(type().outputs[i], given[i], result.given);
  return std::move(result);
}

Error StageWorker::missing_input() const {
  std::string missing;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const StageInput& input = type().inputs[i];
    if (input.held && input.required && !slots[i].value) missing = input.kind.name();
  }
  return Error(node->tag + ": it waited for a " + missing + ", but the stages above gave none",
               "see what they report", node->place);
}

void refuse_overwritten(const StageWorkers& workers, std::size_t index) {
  const auto& own = workers[index].result.report.written;
  for (std::size_t i = 0; i < workers.size(); ++i) {
    const auto& theirs = workers[i].result.report.written;
    const auto same = std::ranges::find_first_of(own, theirs);
    if (i == index || same == own.end()) continue;
    throw Error("it has overwritten " + same->string() + ", which " + workers[i].result.tag + " wrote",
                "let it write another file");
  }
}

}  // namespace crisp::stage
