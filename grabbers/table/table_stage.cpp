// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/table_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <istream>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/files/byte_stream.hpp"

namespace crisp::table {
namespace {

constexpr int kMaxColumns = 1'000'000;
constexpr std::uint64_t kPiece = 1'000'000;  // beams that are held at most, about
constexpr double kMargin = 1;  // [s] by which pieces of the plate's trajectory overlap, for lags

void describe_columns(StageDescription<TableStage>& d, TableFormat TableStage::*format) {
  const auto column = [&](const char* name, auto member, const char* help) {
    d.option(name, format, member, help).range(1, kMaxColumns);
  };
  const auto time_unit = [&](const char* name, auto member, const char* help) {
    d.option(name, format, member, help)
        .choices({{"s", TimeUnit::s}, {"ms", TimeUnit::ms}, {"us", TimeUnit::us}, {"ns", TimeUnit::ns}});
  };
  column("time_column", &TableFormat::time_column, "firing time of the row's first beam; auto: none");
  time_unit("time_unit", &TableFormat::time_unit, "of that");
  column("receipt_column", &TableFormat::receipt_column, "time of receipt of the row; auto: none");
  time_unit("receipt_unit", &TableFormat::receipt_unit, "of that");
  column("counter_column", &TableFormat::counter_column,
         "the device's count of its scans, their time for a clock stage; auto: none");
  d.option("counter_modulus", format, &TableFormat::counter_modulus, "modulus of that count").at_least(2);
  d.option("period", format, &TableFormat::period, "nominal time between two scans; 0: unknown")
      .unit("s")
      .range(0, 1000);
  column("angle_column", &TableFormat::angle_column, "angle of the actuator; auto: the laser is stationary");
  d.option(
       "angle_unit", format, &TableFormat::angle_unit,
       "unit of all angles in the table; counts: the actuator's are counts of the rig's encoder, and mirror angles in rad")
      .choices({{"rad", AngleUnit::rad}, {"deg", AngleUnit::deg}, {"counts", AngleUnit::counts}});
  column("range_column", &TableFormat::range_column, "first range; auto: rows are times alone");
  column("count_column", &TableFormat::count_column, "number of ranges; auto: up to the row's end");
  d.option("range_unit", format, &TableFormat::range_unit, "of ranges")
      .choices({{"m", LengthUnit::m}, {"cm", LengthUnit::cm}, {"mm", LengthUnit::mm}});
  d.option("invalid_from", format, &TableFormat::invalid_from,
           "limit from which ranges, in their unit, mean no echo, as 0 and less always do");
  column("remission_column", &TableFormat::remission_column, "first remission; auto: none");
  column("mirror_column", &TableFormat::mirror_column,
         "reported angle of the row's beam, where a row is one beam; auto: a row is a scan");
  column("laser_column", &TableFormat::laser_column,
         "number of the laser in the rig, from 0; auto: the rig has one");
}

}  // namespace

void TableStage::describe(StageDescription<TableStage>& d) {
  d.name("grabber.table").summary("reads scans with the actuator's angles from text in columns (CSV)");
  d.details(
      "For any laser on an actuator whose recording is a table: a scan a row, or a beam a row, numbers separated by commas, semicolons, tabs or spaces. Lines that begin with # or % and a first line of names are skipped. An unreadable row is dropped and counted; the first is named with its line and column.\n\n"
      "Where laser and actuator share a clock, the resulting measurements can be placed at once. Otherwise a clock stage below aligns the scans and readings: by the device's count of its scans where there is one, else by its time.\n\n"
      "The rig's plate is the actuator, whatever it turns; angles are rounded to its `counts_per_revolution`. docs/reports/reality-gap.md describes a tilting unit. Without an actuator there are no readings, and without ranges no measurements: the times of such a table are for `diagnose.clocks`.");
  d.gives<Scan>().gives<PlateReading>().gives<PlateTrajectory>().gives<Measurements>();
  d.option("file", &TableStage::file_, "the table").required();
  describe_columns(d, &TableStage::format_);
  const auto settings = &TableStage::settings_;
  d.option("start_angle", settings, &TableScanSettings::start_angle, "reported angle of a scan's first beam")
      .unit("rad")
      .range(-100, 100);
  d.option("angle_step", settings, &TableScanSettings::angle_step, "from beam to beam")
      .unit("rad")
      .range(-1, 1);
  d.option("beam_interval", settings, &TableScanSettings::beam_interval, "time from beam to beam")
      .unit("s")
      .range(0, 10);
  d.option("actuator", settings, &TableScanSettings::actuator,
           "motion of the actuator during a row: it moves, or it stands at the row's angle")
      .choices({{"moves", ActuatorMotion::moves}, {"stands", ActuatorMotion::stands}});
  d.option("max_gap", settings, &TableScanSettings::max_gap,
           "longest silence of the angles to interpolate across")
      .unit("s")
      .range(1e-6, 1e6);
  d.option("begin", &TableStage::begin_, "start of the used part, after the first row").unit("s").at_least(0);
  d.option("duration", &TableStage::duration_, "duration of the used part; auto: to the end")
      .unit("s")
      .at_least(0);
}

/// Each column means one thing. Only the time may be that of the receipt.
void TableStage::check_columns() const {
  const std::array<std::pair<const char*, std::optional<int>>, 9> roles = {
      {{"time_column", format_.time_column},
       {"receipt_column", format_.receipt_column},
       {"counter_column", format_.counter_column},
       {"angle_column", format_.angle_column},
       {"range_column", format_.range_column},
       {"count_column", format_.count_column},
       {"remission_column", format_.remission_column},
       {"mirror_column", format_.mirror_column},
       {"laser_column", format_.laser_column}}};
  for (std::size_t i = 0; i < roles.size(); ++i) {
    for (std::size_t j = i == 0 ? 2 : i + 1; j < roles.size(); ++j) {
      if (!roles[i].second || roles[i].second != roles[j].second) continue;
      throw Error(fmt::format("{} and {} are both {}", roles[i].first, roles[j].first, *roles[i].second),
                  "columns count from 1; give each role its own");
    }
  }
}

void TableStage::check(const RunSettings& run) const {
  AllErrors errors;
  errors.keep_of([&] { check_columns(); });
  const auto refuse_if = [&](bool wrong, std::string what, std::string advice) {
    if (wrong) errors.add(Error(std::move(what), std::move(advice)));
  };
  const bool timed = format_.time_column || format_.receipt_column;
  refuse_if(!timed && format_.period == 0, "the times of the rows are not defined",
            "give time_column, receipt_column or the period");
  refuse_if(timed && format_.counter_column && format_.period == 0,
            "a count of scans requires the time between two scans", "give the period");
  refuse_if(
      !format_.range_column && (format_.mirror_column || format_.count_column || format_.remission_column),
      "no column of ranges is given", "give range_column");
  refuse_if(format_.range_column && !format_.mirror_column && settings_.angle_step == 0,
            "all beams of a scan would have the same angle", "give angle_step, or mirror_column");
  refuse_if(
      run.rig.lasers.size() > 1 && !format_.laser_column,
      fmt::format("the rig has {} lasers, and no column assigns the rows to them", run.rig.lasers.size()),
      "give laser_column, or a rig of one laser");
  errors.throw_any();
}

void TableStage::read(TableReader& reader, TableItems& items, Outputs& out, Context& context) const {
  std::optional<std::int64_t> first_ns;
  std::uint64_t rows = 0;
  while (auto row = reader.next()) {
    const auto time_ns = items.admit(*row);
    if (!time_ns) continue;
    if (!first_ns) first_ns = time_ns;
    const double since = 1e-9 * static_cast<double>(*time_ns - *first_ns) - begin_;
    if (since < 0 || (duration_ && since >= *duration_)) {
      context.count("rows outside of begin and duration");
      continue;
    }
    const auto item = items.add(*row, *time_ns);
    if (item.reading) out.give(*item.reading);
    if (item.scan) out.give(item.scan);
    if (items.beams_held() >= kPiece) give_piece(items, out);
    constexpr std::uint64_t kReportEvery = 1000;
    if (++rows % kReportEvery == 0) {
      if (context.interrupted()) return;
      context.progress(Progress{static_cast<double>(rows), 0, "rows", "reading the table"});
    }
  }
}

void TableStage::give_piece(TableItems& items, Outputs& out) {
  const PlateTrajectory plate = items.trajectory();
  const auto measurements =
      items.take_measurements_until(std::max(plate.end() - kMargin, items.middle_time()));
  if (measurements.empty()) return;
  out.give(plate);
  for (const auto& piece : measurements) out.give(piece);
  items.forget_angles_before(plate.end() - 2 * kMargin);
}

void TableStage::process(const Inputs&, Outputs& out, Context& context) {
  if (std::filesystem::is_directory(file_)) {
    throw Error(file_.string() + " is a folder, not a table", "name the file in it");
  }
  files::ByteStream stream(file_, [&context] { return context.interrupted(); });
  files::ByteStreamBuffer buffer(stream);
  std::istream in(&buffer);
  in.exceptions(std::ios::badbit);
  context.reads(file_);
  TableFormat format = format_;
  format.angle_per_count = std::abs(context.rig().plate.angle_per_count());
  TableReader reader(in, file_.string(), format);
  TableItems items(format_, settings_, context.rig());
  read(reader, items, out, context);
  if (context.interrupted()) return;
  report(reader, items, items.beams(), context);
  if (format_.range_column) out.give(items.trajectory());
  for (const auto& piece : items.take_measurements()) out.give(piece);
}

void TableStage::report(const TableReader& reader, const TableItems& items, std::uint64_t beams,
                        Context& context) const {
  for (const auto* losses : {&reader.losses(), &items.losses()}) {
    for (const auto& [what, n] : *losses) context.count(what, n);
  }
  const auto& fault = reader.first_fault();
  if (format_.range_column ? beams == 0 : reader.rows() == 0) {
    std::error_code none;
    if (std::filesystem::file_size(file_, none) == 0)
      throw Error(file_.string() + " is empty", "copy it again");
    if (fault) throw Error("no row can be read: " + fault->message(), "correct the columns", fault->place());
    throw Error(file_.string() + (format_.range_column ? " holds no range" : " holds no row"),
                "check the table and its columns");
  }
  if (fault) context.warn(to_string(fault->place()) + ": here is the first of the " + fault->message());
  if (const int line = items.first_early_line(); line > 0) {
    context.warn(
        to_string(Place{file_.string(), line, 1}) +
        ": here is the first of the rows that are earlier than the row before. If the row before jumps ahead, remove it; if rows are in another order, sort them by their time");
  }
  if (items.large_steps() > 0) {
    context.warn(fmt::format(
        "{} of {} angles are a turn and a half or more from the one before; check angle_unit (for counts of an encoder, angle_unit: counts)",
        items.large_steps(), items.rows()));
  }
  if (2 * items.overlapping() > items.rows()) {
    context.warn(fmt::format(
        "{} of {} rows begin before the last beam of the row before was fired; check beam_interval",
        items.overlapping(), items.rows()));
  }
  context.report({{"rows", items.rows()}, {"beams", beams}});
  context.print(fmt::format("{} rows with {} ranges", items.rows(), beams));
}

}  // namespace crisp::table
