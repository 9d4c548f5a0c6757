// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/watch/watch_stage.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include <crisp/registrar.hpp>

#include "pipeline/estimate/free_parameters.hpp"

namespace crisp::calibrate {
namespace {

constexpr std::size_t kToChooseFrom =
    2;  // times the beams of a check, which are sampled by the areas they stand for

/// Runs in the background, so that live stages do not wait for it.
template <class Work>
auto in_background(Work& work) {
  constexpr int kNicer = 10;
  setpriority(PRIO_PROCESS, 0, kNicer);  // of this thread, which ends with the work
  tbb::task_arena alone(1);
  return alone.execute(work);
}

}  // namespace

void WatchStage::describe(StageDescription<WatchStage>& d) {
  d.name("calibrate.watch").summary("monitors whether a running scanner's calibration is still valid");
  d.details(
      "For live pipelines, above assemble.deskew: it passes the calibration from above on. Periodically, in the background, it refines the calibration on the beams of the last seconds (as calibrate.refine does). If the refined calibration decreases the RQE of the same points by more than `tolerance`, and a parameter has moved by more than `significance` of its standard errors, the calibration is stale: the status line and the summary report it, and the exit status is 3.\n\n"
      "`recalibrate` determines when the refined calibration replaces the current one: at_start once, with the first check, since lags differ from one start of the devices to the next; when_stale; always. Creating the file `request` triggers a recalibration; the file is then removed. `recalibrate_parameters` selects the lags alone, or the geometry too.\n\n"
      "The work runs in one thread of low priority. Clouds after a recalibration depend on its time, so that a recording does not repeat them to the byte.");
  d.takes<Measurements>().holds<PlateTrajectory>().holds<Calibration>().gives<Calibration>();
  d.option("seconds", &WatchStage::seconds_, "duration of the beams in a check").unit("s").range(0.5, 600);
  d.option("every", &WatchStage::every_, "interval of the checks").unit("s").range(0.5, 1e6);
  d.option("recalibrate", &WatchStage::recalibrate_, "when to recalibrate without a request")
      .choices({{"never", Recalibrate::Never},
                {"at_start", Recalibrate::AtStart},
                {"when_stale", Recalibrate::WhenStale},
                {"always", Recalibrate::Always}});
  d.option("recalibrate_parameters", &WatchStage::settings_, &CheckSettings::parameters,
           "parameters to recalibrate: the lags alone, or all")
      .choices({{"lags", RecalibratedParameters::Lags}, {"all", RecalibratedParameters::All}});
  d.option("request", &WatchStage::request_,
           "file whose creation requests a recalibration at once; none: no file");
  d.option("sigma", &WatchStage::settings_, &CheckSettings::sigma, "kernel width of the RQE")
      .unit("m")
      .range(1e-3, 1);
  d.option("tolerance", &WatchStage::settings_, &CheckSettings::tolerance,
           "largest excess of RQE over that of the refined calibration [nat]; raise it in changing scenes")
      .range(0, 10);
  d.option("significance", &WatchStage::settings_, &CheckSettings::significance,
           "standard errors by which a parameter must have moved for the calibration to be stale")
      .range(0, 1000);
  d.option("beams", &WatchStage::settings_, &CheckSettings::beams, "number of beams in a check")
      .range(1000, 1e7);
  d.option("fixed", &WatchStage::settings_, &CheckSettings::refinement, &estimate::RefinementSettings::fixed,
           "parameters that are held: laser1.eta, or eta for that of all lasers");
  d.option(
       "noise", [](WatchStage & stage) -> auto& { return stage.settings_.refinement.surfels.noise; },
       "standard deviation of a range")
      .unit("m")
      .range(1e-6, 1);
}

WatchStage::~WatchStage() {
  stop_ = true;  // the future's destructor waits for the check
}

void WatchStage::check(const RunSettings& run) const {
  estimate::check_fixed(settings_.refinement.fixed, nominal_calibration(run.rig));
}

void WatchStage::process(const Inputs& in, Outputs& out, Context& context) {
  if (auto above = in.share<Calibration>(); above != given_) {
    given_ = calibration_ = std::move(above);
    out.give(calibration_);
  }
  if (!recent_) {
    recent_.emplace(seconds_);
    due_ = 0;
  }
  recent_->add(
      {in.share<Measurements>(), oriented_(in.share<PlateTrajectory>(), calibration_.get(), context.rig())});
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) end_check(out, context);
  } else if (is_due()) {
    begin_check(context);
  }
}

bool WatchStage::is_due() {
  constexpr double kEnough = 0.9;  // of the seconds that are wanted
  requested_ = requested_ || is_requested();
  return recent_->duration() >= kEnough * seconds_ && (requested_ || recent_->latest() >= due_);
}

bool WatchStage::is_requested() {
  constexpr double kPollEvery = 0.5;  // [s]
  if (request_.empty() || recent_->latest() - checked_ < kPollEvery) return false;
  checked_ = recent_->latest();
  std::error_code ignored;
  return std::filesystem::remove(request_, ignored);
}

RecalibrationPolicy WatchStage::policy() const {
  const bool first = recalibrate_ == Recalibrate::AtStart && checks_ == 0;
  if (requested_ || first || recalibrate_ == Recalibrate::Always) return RecalibrationPolicy::Yes;
  return recalibrate_ == Recalibrate::WhenStale ? RecalibrationPolicy::IfStale : RecalibrationPolicy::No;
}

void WatchStage::begin_check(Context& context) {
  due_ = recent_->latest() + every_;
  auto check = [this, batches = recent_->batches(), calibration = calibration_, rig = context.rig(),
                terms = context.run().registrar->get<TermRegistry>(), policy = policy()]() mutable {
    PlateTrajectory plate;
    // Beams outside of a check can be replaced while it runs.
    const estimate::Sample sample =
        sample_of(std::exchange(batches, {}), kToChooseFrom * settings_.beams, plate);
    return check_calibration(*calibration, sample, rig, terms, settings_, policy, [this] { return !stop_; });
  };
  running_ =
      std::async(std::launch::async, [check = std::move(check)]() mutable { return in_background(check); });
}

void WatchStage::end_check(Outputs& out, Context& context) {
  try {
    judge(running_.get(), out, context);
  } catch (const Error& error) {  // what is seen just now shows no surfaces: another time
    context.count("failed checks of the calibration");
    line_ = "calibration not checked: " + error.message();
    if (requested_) note("not recalibrated: " + error.message(), context);
  }
  requested_ = false;
  report(context);
}

void WatchStage::judge(CalibrationCheck found, Outputs& out, Context& context) {
  ++checks_;
  stale_ += found.stale ? 1 : 0;
  const bool was_good = std::exchange(good_, !found.stale);
  rqe_ = found.rqe;
  best_rqe_ = found.best_rqe;
  if (found.recalibration) {
    const double rqe = found.recalibration->rqe;
    if (take(std::move(*found.recalibration), out, context)) {
      rqe_ = rqe;
      good_ = good_ || rqe - best_rqe_ <= settings_.tolerance;
    }
  }
  line_ = fmt::format("RQE {:.3f}, {:.3f} above the best", rqe_, std::max(0.0, rqe_ - best_rqe_));
  if (good_) return;
  line_ += ", the calibration is stale: " + found.moved;
  if (was_good) note("the calibration is stale: " + found.moved, context);
}

bool WatchStage::take(Recalibration found, Outputs& out, Context& context) {
  if (!found.caveats.empty()) {
    context.count("untrusted recalibrations");
    note("not recalibrated: " + found.caveats.front(), context);
    return false;
  }
  ++parameters_;
  events_.emplace_back("recalibrated");
  found.calibration.provenance = calibration_->provenance;
  found.calibration.provenance["recalibration"] = "calibrate.watch";
  calibration_ = std::make_shared<const Calibration>(std::move(found.calibration));
  out.give(calibration_);
  return true;
}

void WatchStage::note(std::string what, Context& context) {
  context.warn(what);
  events_.push_back(std::move(what));
}

void WatchStage::report(Context& context) {
  context.set_status({.line = line_,
                      .gauges = {{"rqe", rqe_},
                                 {"rqe_above_best", rqe_ - best_rqe_},
                                 {"calibration_checks_total", static_cast<double>(checks_)},
                                 {"calibration_stale_total", static_cast<double>(stale_)},
                                 {"recalibrations_total", static_cast<double>(parameters_)}},
                      .events = std::exchange(events_, {})});
}

void WatchStage::finish(Outputs& out, Context& context) {
  if (running_.valid()) end_check(out, context);
  context.report({{"checks", checks_},
                  {"stale", stale_},
                  {"recalibrations", parameters_},
                  {"rqe", rqe_},
                  {"best_rqe", best_rqe_}});
  context.print(fmt::format("{} checks of the calibration, {} of them found it stale; {} recalibrations{}",
                            checks_, stale_, parameters_, line_.empty() ? "" : "; at last " + line_));
  if (!good_) context.mark_untrusted("the calibration is stale: recalibrate");
}

}  // namespace crisp::calibrate
