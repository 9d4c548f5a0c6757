// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/folder_stage.hpp"

#include "pipeline/files/atomic_file.hpp"
#include "pipeline/files/calibration_file.hpp"
#include "plugins/report/folder_content.hpp"

namespace crisp {

void FolderReportStage::describe(StageDescription<FolderReportStage>& d) {
  d.name("report.folder").summary("writes the HTML page of what a run or a batch left in a folder");
  d.details(
      "Of a run: from summary.json, and from calibration.yaml, diagnosis.json, cloud.pcd and the plots where "
      "they are there. Only `write.report` shows the cloud before the calibration as well, and how the plate "
      "turned: a folder does not hold the measurements. Of a batch: from batch.json; each row leads to the "
      "report of its run.");
  d.option("folder", &FolderReportStage::folder_, "where the run or the batch wrote its results").required();
  d.option("file", &FolderReportStage::file_, "where to write it; auto: report.html in the folder").writes();
  d.option("points", &FolderReportStage::points_, "most points that the page's cloud has").range(1, 5e6);
  d.option("against", &FolderReportStage::against_,
           "an earlier calibration of the scanner, whose values are shown next to the new ones; auto: none");
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

}  // namespace crisp
