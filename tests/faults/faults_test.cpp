// SPDX-License-Identifier: BSD-3-Clause
// The program under faults in its system calls: no crash, no file half-written under its final name, inputs
// untouched, every failure named, nothing left over.
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <iostream>
#include <random>

#include "tests/faults/fault_table.hpp"
#include "tests/faults/property.hpp"
#include "tests/faults/scenario.hpp"

namespace crisp::test {
namespace {

FaultTable& all_faults() {
  static FaultTable table;
  return table;
}

/// Prints the table when all tests have run.
class PrintTable : public testing::Environment {
 public:
  void TearDown() override {
    if (all_faults().faults() > 0) std::cout << all_faults().faults() << " faults\n" << all_faults().text();
  }
};
const auto* const kPrintTable = testing::AddGlobalTestEnvironment(new PrintTable);

/// Every fault that the call can have.
std::vector<Fault> faults_of(const FileCall& call) {
  std::vector<Fault> faults = {{call.number, std::to_string(EIO), "EIO"},
                               {call.number, std::to_string(EACCES), "EACCES"},
                               {call.number, std::to_string(ENOSPC), "ENOSPC"},
                               {call.number, std::to_string(EINTR), "EINTR"},
                               {call.number, "full", "full disk"},
                               {call.number, "kill", "SIGKILL"}};
  if (call.name == "write" || call.name == "pwrite") {
    faults.push_back({call.number, "short", "short write"});
    faults.push_back({call.number, "torn", "SIGKILL within"});
  }
  return faults;
}

void inject(const Stage& stage, const FileCall& call, const Fault& fault) {
  const Verdict verdict = judge_fault(stage, fault);
  all_faults().add(call.name, fault.name, verdict);
  for (const auto& violation : verdict.violations) {
    ADD_FAILURE() << stage.scenario().name << ", " << fault.name << " at call " << call.number << ", "
                  << call.name << " of " << call.file.string() << ": " << violation;
  }
}

class Faults : public testing::TestWithParam<Scenario> {};
class EveryFault : public testing::TestWithParam<Scenario> {};

constexpr int kSample = 16;  ///< faults of each scenario

TEST_P(Faults, DrawnAtRandomBreakNothing) {
  const Stage stage(GetParam());
  std::mt19937_64 random(31);
  for (int i = 0; i < kSample; ++i) {
    const FileCall& call = stage.calls()[random() % stage.calls().size()];
    const auto faults = faults_of(call);
    inject(stage, call, faults[random() % faults.size()]);
  }
}

TEST_P(EveryFault, AtEveryCallBreaksNothing) {
  const Stage stage(GetParam());
  for (const auto& call : stage.calls()) {
    for (const auto& fault : faults_of(call)) inject(stage, call, fault);
  }
}

TEST(FaultPreload, SeesTheCallsOfWritersAndMakesThemFail) {
  const Stage stage(scenarios().front());
  for (const std::string name : {"open", "write", "fsync", "rename"}) {
    const auto call = std::ranges::find(stage.calls(), name, &FileCall::name);
    ASSERT_NE(call, stage.calls().end()) << name;
    stage.reset();
    const ProgramEnd end = stage.run({call->number, "kill", "SIGKILL"});
    EXPECT_EQ(end.signal, SIGKILL) << name;
    ASSERT_EQ(end.calls.size(), 1U);
    EXPECT_EQ(end.calls.front().name, name);
  }
}

std::string name_of(const testing::TestParamInfo<Scenario>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Of, Faults, testing::ValuesIn(scenarios()), name_of);
INSTANTIATE_TEST_SUITE_P(Of, EveryFault, testing::ValuesIn(scenarios()), name_of);

}  // namespace

void PrintTo(const Scenario& scenario, std::ostream* out) { *out << scenario.name; }

}  // namespace crisp::test
