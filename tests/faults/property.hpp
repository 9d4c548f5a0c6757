// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tests/faults/program_run.hpp"
#include "tests/faults/stage.hpp"

namespace crisp::test {

/// How a run with a fault ended, and in what it broke the guarantee: nothing crashes, nothing is lost without
/// a word, nothing is half-written.
struct Verdict {
  enum class End { survived, refused, failed, untrusted, killed };
  End end = End::survived;
  std::vector<std::string> violations;
};

/// Runs the program with the fault, from the folder as the earlier run left it, and again without fault where
/// something may be left over.
Verdict judge_fault(const Stage& stage, const Fault& fault);

}  // namespace crisp::test
