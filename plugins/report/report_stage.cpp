// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/report_stage.hpp"

#include <utility>

#include <crisp/atomic_file.hpp>
#include <crisp/calibration_file.hpp>
#include <crisp/registrar.hpp>

#include "pipeline/files/findings_file.hpp"
#include "plugins/report/calibration_json.hpp"
#include "plugins/report/encoded_cloud.hpp"
#include "plugins/report/motion_json.hpp"
#include "plugins/report/run_content.hpp"

namespace crisp::report {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> names_of(const Rig& rig) {
  std::vector<std::string> names;
  for (const auto& laser : rig.lasers) names.push_back(laser.name);
  return names;
}

}  // namespace

void WriteReportStage::describe(StageDescription<WriteReportStage>& d) {
  d.name("write.report").summary("writes an HTML report of the run");
  d.details(
      "One file that opens in a browser from disk and loads nothing: the verdict, the calibration with its standard errors, the cloud in 3D before and after, the devices, the diagnosis with its plots, and the run's provenance. The page is written at the end of the run, as it shows the reports of all stages. docs/how-to/report.md describes it. `crisp report FOLDER` makes one from the results of a run.\n\n"
      "The points are sampled evenly over the surfaces: each cell of a voxel grid of 10 cm keeps equally many. Both clouds show the same beams: before, under the rig's nominal values, and after, under the calibration. For a recording of more than 2 million beams, points are sampled from a part.");
  d.takes<Measurements>()
      .takes<Findings>(Need::optional)
      .holds<PlateTrajectory>()
      .holds<Calibration>(Need::optional);
  d.option("file", &WriteReportStage::file_, "output file, NAME.html").writes().required();
  d.option("points", &WriteReportStage::points_, "maximum number of points in the report's cloud")
      .range(1, 5e6);
  d.option("against", &WriteReportStage::against_,
           "earlier calibration of the scanner to compare with; auto: none");
}

void WriteReportStage::process(const Inputs& in, Outputs&, Context& context) {
  if (auto findings = in.share<Findings>()) findings_ = std::move(findings);
  if (!in.find<Measurements>()) return;
  calibration_ = in.share<Calibration>();
  collected_.add(in.share<Measurements>(),
                 oriented_(in.share<PlateTrajectory>(), calibration_.get(), context.rig()));
  has_beams_ = true;
}

void WriteReportStage::finish(Outputs&, Context& context) {
  const Calibration nominal = nominal_calibration(context.rig());
  Json data = Json::object();
  std::optional<EncodedCloud> cloud;
  if (calibration_) {
    std::optional<Calibration> earlier;
    if (against_) {
      earlier = read_calibration(*against_);
      context.reads(*against_);
    }
    data["calibration"] = calibration_json(*calibration_, nominal, earlier ? &*earlier : nullptr);
  }
  if (findings_) data["findings"] = Json::parse(files::findings_json(*findings_));
  if (has_beams_) {
    const estimate::Sample sample = collected_.sample();
    data["motion"] = motion_json(*sample.plate);
    data["coverage"] = coverage_json(sample, names_of(context.rig()));
    const auto& terms = context.run().registrar->get<TermRegistry>();
    const SensorModel before(nominal, terms);
    if (calibration_) {
      cloud = encode(shown_cloud(sample, before, SensorModel(*calibration_, terms), points_));
    } else {
      ShownCloud only = shown_cloud(sample, before, before, points_);
      only.before = {};
      only.distance_before = {};
      cloud = encode(only);
    }
  }
  data["laser_names"] = names_of(context.rig());
  context.print("the page is " + file_.string());
  context.wrote(file_);
  context.when_recorded(
      [data = std::move(data), cloud = std::move(cloud), file = file_](const Json& summary) {
        PageContent content = run_content(summary);
        content.data.update(data);
        content.cloud = cloud;
        write_file(file, page_html(content));
      });
}

}  // namespace crisp::report
