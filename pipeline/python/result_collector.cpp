// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/python/result_collector.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace crisp::python {
namespace {

/// The tag of the last stage that gives this kind; empty if none does.
template <class T>
std::string last_giver(const Pipeline& pipeline) {
  const auto& nodes = pipeline.nodes;
  const auto last = std::find_if(nodes.rbegin(), nodes.rend(),
                                 [](const PipelineNode& node) { return node.type->gives(Kind::of<T>()); });
  return last != nodes.rend() ? last->tag : std::string();
}

}  // namespace

Results::Results(const Pipeline& pipeline)
    : cloud_tag_(last_giver<Cloud>(pipeline)),
      measurements_tag_(last_giver<Measurements>(pipeline)),
      calibration_tag_(last_giver<Calibration>(pipeline)),
      findings_tag_(last_giver<Findings>(pipeline)) {}

void Results::take(const std::string& tag, const Item& item) {
  if (tag == cloud_tag_) {
    if (auto cloud = item.as<Cloud>()) add(std::move(cloud));
  }
  if (tag == measurements_tag_) {
    if (const auto measurements = item.as<Measurements>()) add(*measurements);
  }
  if (tag == calibration_tag_) {
    if (auto calibration = item.as<Calibration>()) calibration_ = std::move(calibration);
  }
  if (tag == findings_tag_) {
    if (auto findings = item.as<Findings>()) findings_ = std::move(findings);
  }
}

void Results::add(std::shared_ptr<const Cloud> cloud) {
  constexpr std::int64_t kNsPerUs = 1000;
  if (!cloud_) {
    epoch_ns_ = static_cast<std::int64_t>(cloud->header.stamp) * kNsPerUs;
    cloud_ = std::move(cloud);
    return;
  }
  if (!joined_) {
    joined_ = std::make_shared<Cloud>(*cloud_);
    cloud_ = joined_;
  }
  joined_->points.insert(joined_->points.end(), cloud->points.begin(), cloud->points.end());
}

void Results::add(const Measurements& measurements) {
  if (!rows_) {
    rows_ = std::make_shared<std::vector<MeasurementRow>>();
    epoch_ns_ = measurements.epoch_ns;
  }
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    rows_->push_back({.time = measurements.time[i],
                      .range = measurements.range[i],
                      .mirror_angle = measurements.mirror_angle[i],
                      .remission = measurements.remission[i],
                      .laser = measurements.laser[i],
                      .beam = measurements.beam[i]});
  }
}

}  // namespace crisp::python
