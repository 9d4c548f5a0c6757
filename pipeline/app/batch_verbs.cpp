// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>

#include "pipeline/app/batch_commands.hpp"
#include "pipeline/app/batch_report.hpp"
#include "pipeline/batch/last_batch.hpp"
#include "pipeline/batch/ledger.hpp"
#include "pipeline/data/counted.hpp"
#include "pipeline/files/folder_lock.hpp"
#include "pipeline/files/json_text.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;

void print_status(const batch::BatchRows& rows, bool json) {
  if (json) {
    std::cout << files::json_text(batch::head_json(rows), 1) << "\n" << std::flush;
    return;
  }
  const BatchTally tally = tally_of(rows);
  std::cout << fmt::format("{}: {}\n{}",
                           data::counted(std::max(rows.recordings, rows.rows.size()), "recording"),
                           in_words(tally), trouble_text(rows));
  for (const auto& row : rows.rows) {
    if (row.status == "running") std::cout << "  running " << row.name << "\n";
  }
  std::cout << std::flush;
}

/// Adds an event for each recording that failed and matches.
std::size_t ask_again(const BatchRetryRequest& retry) {
  const fs::path task = batch::task_folder(retry.folder, "retry");
  const files::FolderLock lock(task);
  batch::ManifestWriter manifest(task / batch::kManifestFile);
  std::size_t count = 0;
  const auto ledger = batch::BatchLedger::read(retry.folder);
  for (const auto& [name, state] : ledger.all()) {
    const bool failed = state.has_ended() && state.status == batch::JobStatus::failed;
    if (!failed || fnmatch(retry.match.c_str(), name.c_str(), 0) != 0) continue;
    manifest.append(batch::BatchEventKind::retry, {{"name", name}});
    ++count;
  }
  manifest.sync();
  return count;
}

}  // namespace

ExitStatus batch_status_command(const BatchStatusRequest& request) {
  constexpr std::chrono::seconds kWatchEvery{2};
  while (true) {
    const auto rows = batch::read_rows(request.folder);
    print_status(rows, request.json);
    const BatchTally tally = tally_of(rows);
    const bool over = tally.open == 0 && tally.not_begun == 0;
    if (!request.watch || over) return ExitStatus::done;
    std::this_thread::sleep_for(kWatchEvery);
  }
}

ExitStatus batch_table_command(const BatchTableRequest& request, const Registrar& registrar) {
  const auto rows = write_results(request.folder, registrar, nullptr);
  const auto sink = [](std::string_view piece) { std::cout << piece; };
  if (request.json)
    batch::print_json(rows, batch::head_json(rows), sink);
  else
    batch::print_csv(rows, sink);
  return tally_of(rows).exit_status();
}

ExitStatus batch_retry_command(const BatchRetryRequest& retry, BatchRequest request,
                               const Registrar& registrar) {
  const auto last = batch::last_batch(retry.folder);
  if (!last.is_object() || !last.contains("arguments")) {
    print_errors(Error(retry.folder.string() + " is no output folder of a batch: it holds no manifest",
                       "give the folder of crisp batch -o"));
    return ExitStatus::misused;
  }
  const auto& arguments = last["arguments"];
  set_arguments(arguments, request);
  request.output = fs::absolute(retry.folder).lexically_normal();
  const std::size_t count = ask_again(retry);
  if (!request.run.quiet) std::cerr << data::counted(count, "recording") << " to be tried again\n";
  const bool from_list = std::ranges::find(request.inputs, "-") != request.inputs.end();
  if (from_list && !retry.mark)
    std::cerr << "the recordings came from the standard input: run the batch again with that list\n";
  if (from_list || retry.mark) return ExitStatus::done;
  fs::current_path(arguments.at("folder").get<std::string>());
  return batch_command(request, registrar);
}

}  // namespace crisp::app
