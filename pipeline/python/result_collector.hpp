// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/cloud.hpp>
#include <crisp/findings.hpp>
#include <crisp/measurements.hpp>
#include <crisp/pipeline.hpp>

namespace crisp::python {

/// One measurement as a row of a table.
struct MeasurementRow {
  double time = 0;         ///< [s since the epoch]
  float range = 0;         ///< [m]
  float mirror_angle = 0;  ///< [rad]
  float remission = 0;
  std::uint16_t laser = 0;
  std::uint16_t beam = 0;
};

/// A run's results in memory: of each kind the item of the last stage that gives it.
class Results {
 public:
  explicit Results(const Pipeline& pipeline);

  /// To be called with all that the stages give.
  void take(const std::string& tag, const Item& item);

  /// All clouds as one, in the order in which they were given; a single one as it was given, uncopied. Null
  /// if there was none.
  const std::shared_ptr<const Cloud>& cloud() const { return cloud_; }
  const std::shared_ptr<std::vector<MeasurementRow>>& rows() const { return rows_; }
  const std::shared_ptr<const Calibration>& calibration() const { return calibration_; }
  const std::shared_ptr<const Findings>& findings() const { return findings_; }
  /// [ns since the Unix epoch] zero of the times of points and measurements
  std::int64_t epoch_ns() const { return epoch_ns_; }

 private:
  void add(std::shared_ptr<const Cloud> cloud);
  void add(const Measurements& measurements);

  std::string cloud_tag_, measurements_tag_, calibration_tag_, findings_tag_;
  std::shared_ptr<const Cloud> cloud_;
  std::shared_ptr<Cloud> joined_;  ///< of several; cloud_ is the same then
  std::shared_ptr<std::vector<MeasurementRow>> rows_;
  std::shared_ptr<const Calibration> calibration_;
  std::shared_ptr<const Findings> findings_;
  std::int64_t epoch_ns_ = 0;
};

}  // namespace crisp::python
