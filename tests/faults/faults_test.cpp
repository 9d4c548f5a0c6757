// SPDX-License-Identifier: BSD-3-Clause
// The program under faults in its system calls: no crash, no file half-written under its final name, inputs
// untouched, every failure named, nothing left over.
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <iostream>
#include <random>

#include "tests/faults/fault_table.hpp"
#include "tests/faults/property.hpp"
#include "tests/faults/scenario.hpp"
#include "tests/faults/stage.hpp"

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

Fault failing(const FileCall& call, int code) {
  return {call.number, std::to_string(code), strerrorname_np(code)};
}

/// Every fault that the call can have.
std::vector<Fault> faults_of(const FileCall& call) {
  if (call.needs_memory()) return {failing(call, ENOMEM), {call.number, "starved", "no memory from then on"}};
  std::vector<Fault> faults = {failing(call, EIO),
                               failing(call, EACCES),
                               failing(call, ENOSPC),
                               failing(call, EINTR),
                               {call.number, "full", "full disk"},
                               {call.number, "kill", "SIGKILL"}};
  if (call.name == "write" || call.name == "pwrite") {
    faults.push_back({call.number, "short", "short write"});
    faults.push_back({call.number, "torn", "SIGKILL within"});
  }
  return faults;
}

/// Further ways in which a call can fail.
std::vector<Fault> rarer_faults_of(const FileCall& call) {
  std::vector<Fault> faults;
  if (call.needs_memory()) return faults;
  for (const int code : {EDQUOT, EFBIG, EROFS, EPERM, EMFILE, ENFILE, ENOMEM, EBUSY, ESTALE, ETIMEDOUT, ENXIO,
                         ENODEV, EAGAIN, ENAMETOOLONG, ELOOP}) {
    faults.push_back(failing(call, code));
  }
  return faults;
}

void judge(const Stage& stage, const std::string& call, const Fault& fault, const std::string& where) {
  const Verdict verdict = judge_fault(stage, fault);
  all_faults().add(stage.scenario().name, call, fault.name, verdict);
  for (const auto& violation : verdict.violations)
    ADD_FAILURE() << stage.scenario().name << ", " << fault.name << where << ": " << violation;
}

void inject(const Stage& stage, const FileCall& call, const Fault& fault) {
  judge(stage, call.name, fault,
        " at call " + std::to_string(call.number) + ", " + call.name + " of " + call.file.string());
}

/// Kills the program at moments drawn at random.
void kill_at_random(const Stage& stage, int times, std::mt19937_64& random) {
  for (int i = 0; i < times; ++i) {
    const std::chrono::microseconds after(1 + static_cast<long>(random() % stage.lasted().count()));
    judge(stage, "at any moment", {.name = "SIGKILL", .killed_after = after},
          " after " + std::to_string(after.count()) + " us");
  }
}

class Faults : public testing::TestWithParam<Scenario> {};
class EveryFault : public testing::TestWithParam<Scenario> {};
class RarerFaults : public testing::TestWithParam<Scenario> {};

constexpr int kSample = 16;  ///< faults of each scenario
constexpr int kKills = 4;
constexpr int kManyKills = 40;

TEST_P(Faults, DrawnAtRandomBreakNothing) {
  const Stage stage(GetParam());
  std::mt19937_64 random(31);
  for (int i = 0; i < kSample; ++i) {
    const FileCall& call = stage.calls()[random() % stage.calls().size()];
    const auto faults = faults_of(call);
    inject(stage, call, faults[random() % faults.size()]);
  }
  kill_at_random(stage, kKills, random);
}

TEST_P(EveryFault, AtEveryCallBreaksNothing) {
  const Stage stage(GetParam());
  for (const auto& call : stage.calls()) {
    for (const auto& fault : faults_of(call)) inject(stage, call, fault);
  }
  std::mt19937_64 random(32);
  kill_at_random(stage, kManyKills, random);
}

TEST_P(RarerFaults, AtEveryCallBreakNothing) {
  const Stage stage(GetParam());
  for (const auto& call : stage.calls()) {
    for (const auto& fault : rarer_faults_of(call)) inject(stage, call, fault);
  }
  std::mt19937_64 random(33);
  kill_at_random(stage, 5 * kManyKills, random);
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
INSTANTIATE_TEST_SUITE_P(Of, RarerFaults, testing::ValuesIn(scenarios()), name_of);

}  // namespace

void PrintTo(const Scenario& scenario, std::ostream* out) { *out << scenario.name; }

}  // namespace crisp::test
