// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include <crisp/runner.hpp>

namespace crisp::stage {

/// One stage at work: its inputs' latest items, and what waits for those that are not there yet.
struct StageWorker {
  /// A pipe to an input of another worker.
  struct Edge {
    Kind kind;
    std::size_t to;
    std::size_t input;
  };

  PipelineNode* node = nullptr;
  NodeResult result;
  std::vector<Item> slots;           ///< one an input, with a null value where nothing is there
  std::vector<std::size_t> open;     ///< for each input, how many of its feeders have not finished
  std::vector<std::uint64_t> taken;  ///< for each input, how many items came
  std::vector<std::uint64_t> given;  ///< for each of the type's outputs, how many went
  std::deque<std::pair<std::size_t, Item>> waiting;  ///< (input, item) in order of arrival
  std::vector<Edge> edges;                           ///< to everything that this one feeds
  std::size_t announced = 0;                         ///< number of caveats given to the hook
  std::optional<Outputs> out;                        ///< argument of each call, as is the context
  std::optional<Context> context;

  /// Empty slots and no edges.
  explicit StageWorker(PipelineNode& stage);

  const StageType& type() const { return *node->type; }
  /// Whether the stage can run: everything that it holds is there, or will never come and is optional.
  bool is_ready() const;
  /// Counts an item that the stage gives.
  /// @throws Error  if the item is null or of an undeclared kind
  void count_given(const Item& item);
  /// Moves the result out, with the numbers of items.
  NodeResult take_result();
  /// Error of a stage that ends before the items that it holds came.
  Error missing_input() const;
};

/// The workers of a pipeline, in its order: each feeds such as come behind it only.
using StageWorkers = std::deque<StageWorker>;

/// Stages declare the files that they write, and are checked before the run; this is for those that do not.
/// @throws Error  if the stage at `index` wrote a file of another one
void refuse_overwritten(const StageWorkers& workers, std::size_t index);

}  // namespace crisp::stage
