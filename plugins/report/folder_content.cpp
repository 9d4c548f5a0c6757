// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/folder_content.hpp"

#include <system_error>

#include <crisp/calibration_file.hpp>
#include <crisp/cloud_conversion.hpp>
#include <crisp/error.hpp>

#include "pipeline/files/renamed_names.hpp"
#include "pipeline/files/utc_now.hpp"
#include "pipeline/pcd/parts.hpp"
#include "pipeline/stage/files_written.hpp"
#include "plugins/report/calibration_json.hpp"
#include "plugins/report/run_content.hpp"
#include "plugins/report/use_json.hpp"

namespace crisp::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kBatch = "batch.json";

bool is_file(const fs::path& file) {
  std::error_code none;
  return fs::is_regular_file(file, none);
}

/// All parts of a cloud as one.
Cloud cloud_in(const fs::path& file, std::vector<fs::path>& read) {
  Cloud all;
  pcd::read_parts(file, [&](const PcdTable& table, const fs::path& part) {
    all += *cloud_of(table).cloud;
    read.push_back(part);
  });
  return all;
}

PageContent batch_content(const fs::path& folder, Json batch) {
  for (Json& row : batch.at("rows")) {
    const fs::path page = fs::path(row.value("name", "")) / "report.html";
    if (is_file(folder / page)) row["report"] = page.generic_string();
  }
  PageContent content{.title = folder.filename().string(), .data = {}, .plots = {}, .cloud = {}};
  content.data = {{"kind", "batch"}, {"written", files::utc_now()}, {"batch", std::move(batch)}};
  return content;
}

/// Adds results that stages wrote next to the summary of their run.
void add_results(const fs::path& folder, const FolderPageSettings& settings, FolderPage& page) {
  Json& data = page.content.data;
  if (const fs::path file = folder / "calibration.yaml"; is_file(file)) {
    const Calibration calibration = read_calibration(file);
    data["calibration"] =
        calibration_json(calibration, settings.nominal, settings.against ? &*settings.against : nullptr);
    data["laser_names"] = data["calibration"]["lasers"];
    page.read.push_back(file);
  }
  if (const fs::path file = folder / "diagnosis.json"; is_file(file)) {
    data["findings"] = use_json(file, [](Json findings) {
      files::rename_old_keys(findings, "diagnosis");
      return findings;
    });
    page.read.push_back(file);
  }
  const fs::path cloud = folder / "cloud.pcd";
  if (is_file(cloud) || is_file(pcd::part_path(cloud, 1)))
    page.content.cloud = encode(shown_cloud(cloud_in(cloud, page.read), settings.points));
}

}  // namespace

FolderPage folder_page(const fs::path& folder, const FolderPageSettings& settings) {
  FolderPage page;
  if (const fs::path file = folder / kBatch; is_file(file)) {
    page.content = use_json(file, [&](const Json& batch) { return batch_content(folder, batch); });
    page.read.push_back(file);
    return page;
  }
  const fs::path file = folder / stage::kSummary;
  if (!is_file(file)) {
    throw Error(folder.string() + " holds neither summary.json nor batch.json",
                "give the output folder of crisp run or crisp batch (-o)");
  }
  page.content = use_json(file, [&](Json summary) {
    files::rename_old_keys(summary, "summary");
    return run_content(summary, folder);
  });
  page.read.push_back(file);
  add_results(folder, settings, page);
  return page;
}

}  // namespace crisp::report
