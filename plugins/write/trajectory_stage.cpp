// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/trajectory_stage.hpp"

#include <fmt/format.h>

#include <cmath>

namespace crisp::write {
namespace {

/// "1700000000.123456789": an instant in seconds since 1970, all nanoseconds of it.
void append_instant(std::string& to, std::int64_t epoch_ns, double time) {
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  const std::int64_t ns = epoch_ns + std::llround(time * static_cast<double>(kNanoseconds));
  const std::int64_t size = std::abs(ns);
  fmt::format_to(std::back_inserter(to), "{}{}.{:09}", ns < 0 ? "-" : "", size / kNanoseconds,
                 size % kNanoseconds);
}

}  // namespace

void WriteTrajectoryStage::describe(StageDescription<WriteTrajectoryStage>& d) {
  d.name("write.trajectory").summary("writes the plate's angles over time as a table (CSV)");
  d.details(
      "A row is an encoder reading on the hub's clock: time [s since 1970], angle [rad, unwrapped, counter-clockwise seen from +z] and rate [rad/s]. The lag η of a laser is not applied.");
  d.takes<PlateTrajectory>();
  d.option("file", &WriteTrajectoryStage::path_, "output file, NAME.csv").writes().ending(".csv").required();
}

void WriteTrajectoryStage::process(const Inputs& in, Outputs&, Context&) {
  constexpr std::size_t kAtOnce = 1 << 16;  // [bytes]
  const auto& plate = in.get<PlateTrajectory>();
  if (!file_) file_.emplace(path_).write("time,angle,rate\n");
  std::string rows;
  for (std::size_t i = 0; i < plate.size(); ++i) {
    append_instant(rows, plate.epoch_ns(), plate.times()[i]);
    fmt::format_to(std::back_inserter(rows), ",{},{}\n", plate.angles()[i], plate.rates()[i]);
    if (rows.size() < kAtOnce) continue;
    file_->write(rows);
    rows.clear();
  }
  file_->write(rows);
  readings_ += plate.size();
}

void WriteTrajectoryStage::finish(Outputs&, Context& context) {
  if (!file_ || readings_ == 0)
    throw Error("there are no encoder readings to write", "see the losses and warnings above for the cause");
  file_->commit();
  context.wrote(path_);
  context.print(fmt::format("{} readings in {}", readings_, path_.string()));
  context.report({{"readings", readings_}});
}

}  // namespace crisp::write
