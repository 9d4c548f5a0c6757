// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/app/commands.hpp"

namespace crisp::app {

/// `crisp monte-carlo` and `crisp basin`.
struct StudyRequest {
  RunRequest run;
  std::string stage;   ///< "study.basin"
  std::string shard;   ///< "3/64": that part of the runs alone; empty: all of them
  bool merge = false;  ///< of what the parts gave
};

/// Runs a study, or a part of it whose results go to OUTPUT/parts/I-of-N, or merges all parts: what it then
/// writes is the same as that of a study without parts.
ExitStatus study_command(StudyRequest request, const Registrar& registrar);

}  // namespace crisp::app
