// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/batch_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ostream>
#include <system_error>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/app/own_pipelines.hpp"
#include "pipeline/batch/output_name.hpp"
#include "pipeline/batch/trend.hpp"

namespace crisp::app {
namespace {

using batch::kBatchTable;
namespace fs = std::filesystem;

nlohmann::ordered_json batch_summary(const batch::BatchRows& rows,
                                     const std::vector<batch::ParameterTrend>& trends) {
  auto json = batch::head_json(rows);
  json["trend"] = batch::trend_json(trends);
  return json;
}

/// As `crisp report` does, which prints its own errors.
/// @throws Error if the report was not written
void write_report(const fs::path& output, const Registrar& registrar) {
  RunRequest request{
      .file = "report.yaml", .text = kReportPipeline, .arguments = {}, .quiet = true, .metrics = {}};
  request.arguments.input = output;
  const ExitStatus status = run_command(request, registrar);
  if (status == ExitStatus::done || status == ExitStatus::not_trusted) return;
  throw Error(fmt::format("{} was not written; {} and {} are complete", batch::kBatchReport, kBatchTable,
                          batch::kBatchSummary),
              fmt::format("the message above says why: `crisp batch table {}` writes it when that is mended",
                          output.string()));
}

}  // namespace

void BatchTally::add(const std::map<batch::JobStatus, std::size_t>& kept) {
  for (const auto& [status, count] : kept) {
    if (status == batch::JobStatus::done)
      done += count;
    else if (status == batch::JobStatus::untrusted)
      untrusted += count;
    else
      failed += count;
  }
}

ExitStatus BatchTally::exit_status() const {
  if (failed > 0 || open > 0 || not_begun > 0) return ExitStatus::failed;
  return untrusted > 0 ? ExitStatus::not_trusted : ExitStatus::done;
}

BatchTally tally_of(const batch::BatchRows& rows) {
  const std::size_t begun = rows.rows.size();
  return {.done = rows.count("done"),
          .untrusted = rows.count("untrusted"),
          .failed = rows.count("failed") + rows.count("interrupted"),
          .open = rows.count("due") + rows.count("running"),
          .not_begun = rows.recordings > begun ? rows.recordings - begun : 0};
}

std::string in_words(const BatchTally& tally) {
  std::string text =
      fmt::format("{} done, {} untrusted, {} failed", tally.done, tally.untrusted, tally.failed);
  if (tally.open > 0) text += fmt::format(", {} running or due", tally.open);
  if (tally.not_begun > 0) text += fmt::format(", {} not begun", tally.not_begun);
  return text;
}

std::string trouble_text(const batch::BatchRows& rows) {
  constexpr std::size_t kMax = 20;
  std::string text;
  std::size_t count = 0;
  for (const auto& row : rows.rows) {
    const bool is_fine = row.status == "done" || row.status == "running" || row.status == "due";
    if (is_fine || ++count > kMax) continue;
    text += fmt::format("  {} {}: {}\n", row.status, row.name, fmt::join(row.reasons, "; "));
  }
  if (count > kMax) text += fmt::format("  and {} more, see {}\n", count - kMax, kBatchTable);
  return text;
}

bool are_tables_current(const fs::path& output) {
  std::error_code missing;
  const std::string last = std::string(batch::kBatchReport) + kProvenance;
  for (const auto& name : {std::string(kBatchTable), std::string(batch::kBatchSummary), last}) {
    const auto written = fs::last_write_time(output / name, missing);
    if (missing) return false;
    for (const auto& manifest : batch::manifests_of(output)) {
      if (fs::last_write_time(manifest) > written) return false;
    }
  }
  return true;
}

std::string trend_text(const batch::BatchRows& rows) {
  constexpr std::size_t kMax = 20;
  std::string text;
  std::size_t count = 0;
  for (const auto& row : rows.rows) {
    if (row.stands_out.empty() || ++count > kMax) continue;
    text += fmt::format("  {} is an outlier in {}\n", row.name, fmt::join(row.stands_out, ", "));
  }
  if (2 * count > rows.count("done"))
    return fmt::format(
        "  {} calibrations differ by more than their standard errors: they are of several scanners, or the standard errors are too small\n",
        count);
  if (count > kMax) text += fmt::format("  and {} more, see {}\n", count - kMax, kBatchTable);
  return text;
}

batch::BatchRows write_results(const fs::path& output, const Registrar& registrar, std::ostream* out) {
  auto rows = batch::read_rows(output);
  const auto trends = batch::batch_trend(rows.rows);
  batch::mark_outstanding(trends, rows.rows);
  std::error_code none;
  if (trends.empty())
    fs::remove(output / batch::kBatchTrend, none);  // of an earlier batch
  else
    write_file(output / batch::kBatchTrend, batch::trend_svg(trends));
  AtomicFile table(output / kBatchTable);
  batch::print_csv(rows, [&](std::string_view piece) { table.write(piece); });
  table.commit();
  AtomicFile summary(output / batch::kBatchSummary);
  batch::print_json(rows, batch_summary(rows, trends), [&](std::string_view piece) { summary.write(piece); });
  summary.commit();
  write_report(output, registrar);
  if (out) {
    *out << fmt::format("{}\n{}{}wrote {} and {}\n", in_words(tally_of(rows)), trouble_text(rows),
                        trend_text(rows), (output / kBatchTable).string(), batch::kBatchReport);
  }
  return rows;
}

}  // namespace crisp::app
