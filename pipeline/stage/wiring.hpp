// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/stage/pipeline.hpp"

namespace crisp {

/// Fills in `feeders` of every node, and adds an error for each input that nothing feeds and for each entry
/// of `inputs` that feeds nothing. Nodes whose stage is not known are passed over: their error stands
/// already.
void connect(Pipeline& pipeline, const std::vector<StageSpec>& specs, const StageRegistry& registry,
             std::vector<Error>& errors);

/// A warning for each stage below all that would take what it gives: a filter under the writer, say. To be
/// asked of a pipeline that is connected.
std::vector<PipelineWarning> put_too_low(const Pipeline& pipeline);

}  // namespace crisp
