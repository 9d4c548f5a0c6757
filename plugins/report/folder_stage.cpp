// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/folder_stage.hpp"

#include <crisp/atomic_file.hpp>
#include <crisp/calibration_file.hpp>

#include "plugins/report/folder_content.hpp"

namespace crisp::report {

void FolderReportStage::describe(StageDescription<FolderReportStage>& d) {
  d.name("report.folder").summary("writes an HTML report of a run's or a batch's results");
  d.details(
      "For a run: from summary.json, and from calibration.yaml, diagnosis.json, cloud.pcd and the plots if they exist. Only `write.report` also shows the cloud before the calibration and the motion of the plate, since a folder does not hold the measurements. For a batch: from batch.json; each row links to the report of its run.");
  d.option("folder", &FolderReportStage::folder_, "folder of the results").required();
  d.option("file", &FolderReportStage::file_, "output file; auto: report.html in the folder").writes();
  d.option("points", &FolderReportStage::points_, "maximum number of points in the report's cloud")
      .range(1, 5e6);
  d.option("against", &FolderReportStage::against_,
           "earlier calibration of the scanner to compare with; auto: none");
}

void FolderReportStage::process(const Inputs&, Outputs&, Context& context) {
  const auto folder = std::filesystem::absolute(folder_ / "").lexically_normal().parent_path();
  FolderPageSettings settings{
      .points = points_, .nominal = nominal_calibration(context.rig()), .against = {}};
  if (against_) {
    settings.against = read_calibration(*against_);
    context.reads(*against_);
  }
  const FolderPage page = folder_page(folder, settings);
  for (const auto& file : page.read) context.reads(file);
  const auto file = file_.value_or(folder / "report.html");
  write_file(file, page_html(page.content));
  context.wrote(file);
}

}  // namespace crisp::report
