// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "pipeline/data/oriented_plate.hpp"
#include "plugins/calibrate/watch/calibration_check.hpp"
#include "plugins/calibrate/watch/sliding_window.hpp"

namespace crisp::calibrate {

/// When the calibration is found anew.
enum class Recalibrate : std::uint8_t { Never, AtStart, WhenStale, Always };

/// `calibrate.watch`: passes a calibration on, and checks in the background whether it is still good.
class WatchStage final : public Stage {
 public:
  ~WatchStage() override;
  static void describe(StageDescription<WatchStage>& d);
  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  bool is_due();
  bool is_requested();
  RecalibrationPolicy policy() const;
  void begin_check(Context& context);
  void end_check(Outputs& out, Context& context);
  void judge(CalibrationCheck found, Outputs& out, Context& context);
  bool take(Recalibration found, Outputs& out, Context& context);
  void note(std::string what, Context& context);
  void report(Context& context);

  CheckSettings settings_;
  double seconds_ = 10;
  double every_ = 60;
  Recalibrate recalibrate_ = Recalibrate::Never;
  std::filesystem::path request_;

  data::OrientedPlate oriented_;
  std::optional<SlidingWindow> recent_;
  std::shared_ptr<const Calibration> calibration_;  ///< that is in use
  std::shared_ptr<const Calibration> given_;        ///< from above
  double due_ = 0;                                  ///< [s since the epoch] the next check
  double checked_ = 0;                              ///< [s since the epoch] for a request
  bool requested_ = false;                          ///< the next or current check was requested
  std::atomic<bool> stop_ = false;                  ///< the check that runs
  std::future<CalibrationCheck> running_;
  std::uint64_t checks_ = 0, stale_ = 0, parameters_ = 0;
  bool good_ = true;  ///< the calibration in use, as far as is known
  std::string line_;
  std::vector<std::string> events_;  ///< not yet reported
  double rqe_ = 0, best_rqe_ = 0;
};

}  // namespace crisp::calibrate
