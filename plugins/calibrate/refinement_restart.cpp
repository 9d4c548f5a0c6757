// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/refinement_restart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include <crisp/error.hpp>
#include <crisp/registrar.hpp>

#include "pipeline/estimate/requested_terms.hpp"
#include "plugins/calibrate/fit_check.hpp"
#include "plugins/calibrate/report.hpp"
#include "plugins/calibrate/rig_check.hpp"
#include "plugins/calibrate/rig_search.hpp"
#include "plugins/calibrate/sequential_calibration.hpp"

namespace crisp::calibrate {
namespace {

using estimate::Refinement;
using estimate::RefinementSettings;

bool contradicts_rig(const Refinement& refined, const Rig& rig) {
  return !check_with_rig(estimate::calibration_of(refined.outcome, rig), rig, {}).caveats.empty();
}

/// Whether views agree, and so do the data and the rig.
bool fits(const Refinement& refined, const Rig& rig) {
  if (!agrees_well(refined) || !refined.outcome.caveats.empty()) return false;
  const Calibration found = estimate::calibration_of(refined.outcome, rig);
  const RigCheck check = check_with_rig(found, rig, {});
  return check.caveats.empty() || in_direction_of_rig(found, rig, check);
}

class Restart {
 public:
  Restart(const Refinement& refined, const estimate::Sample& sample, const Calibration& start,
          const RefinementSettings& settings, Context& context)
      : refined_(refined),
        sample_(sample),
        start_(start),
        settings_(settings),
        context_(context),
        rig_(context.rig()) {}

  std::optional<Refinement> from_nominal_values() {
    for (const SensorModel& start : nominal_models()) {
      RefinementSettings settings = settings_;
      for (auto& [name, known] : settings.prior.nominal)
        known.value = estimate::picked(start, {start.index(name)})[0];
      if (auto again = fitting(start, settings, "the rig's nominal values")) return again;
    }
    return std::nullopt;
  }

  std::optional<Refinement> one_by_one() {
    const std::vector<bool> agreeing = agreeing_lasers(refined_);
    if (std::ranges::count(agreeing, false) > 0) {
      if (auto again = aligned(refined_.outcome.model, agreeing, "the lasers that agree")) return again;
    }
    std::vector<bool> first(agreeing.size(), false);
    first.front() = true;
    return aligned(nominal_models().front(), first, "the first laser");
  }

 private:
  const TermRegistry& terms() const { return context_.run().registrar->get<TermRegistry>(); }

  std::vector<SensorModel> nominal_models() const {
    std::vector<Calibration> values = {nominal_calibration(rig_)};
    if (rig_.plate.direction == CountDirection::automatic) values.push_back(mirrored(values.front()));
    std::vector<SensorModel> models;
    for (Calibration& from : values) {
      from.direction = start_.direction;
      estimate::add_requested_terms(from, settings_.terms, terms());
      models.emplace_back(from, terms());
    }
    return models;
  }

  std::optional<Refinement> aligned(const SensorModel& model, const std::vector<bool>& agreeing,
                                    std::string_view origin) {
    const auto& registrar = *context_.run().registrar;
    const auto measure =
        registrar.get<MeasureRegistry>().make("rqe", MeasureSettings{}, registrar.get<SearchRegistry>());
    const estimate::ParameterPrior range =
        search_range_with_lambda(SensorModel(nominal_calibration(rig_), terms()), rig_, {});
    try {
      const SensorModel start =
          calibrated_one_by_one(model, agreeing, sample_, range, settings_, *measure, rounds_of(context_));
      return fitting(start, settings_, fmt::format("{}, to which the others were added one by one", origin));
    } catch (const Error&) {
      return std::nullopt;  // no flat surfaces from there
    }
  }

  /// With few beams first, which most starts that lead nowhere do not pass.
  std::optional<Refinement> fitting(const SensorModel& start, const RefinementSettings& settings,
                                    std::string_view origin) {
    constexpr std::size_t kFew = 200'000;
    constexpr std::uint64_t kSeed = 1;
    const bool has_many = sample_.beams.size() > 2 * kFew;
    const auto few =
        has_many ? refined_from(start, estimate::thin_evenly(sample_, kFew, kSeed), settings) : std::nullopt;
    if (has_many && !few) return std::nullopt;
    auto again = refined_from(few ? few->outcome.model : start, sample_, settings);
    // A wrong rig folds the scene onto few surfaces, on which views can agree.
    if (again && again->beams < refined_.beams) return std::nullopt;
    if (again) {
      context_.print(fmt::format(
          "refined from {}, since the values of the stage before lead to a local minimum: views agree on at least {:.0f} % of their common flat surfaces there, and on {:.0f} % here",
          origin, 100 * least_agreement(refined_), 100 * least_agreement(*again)));
    }
    return again;
  }

  /// A refinement that fits.
  std::optional<Refinement> refined_from(const SensorModel& start, const estimate::Sample& sample,
                                         const RefinementSettings& settings) {
    if (context_.interrupted()) return std::nullopt;
    try {
      Refinement again = estimate::refine_by_surfels(start, sample, settings, rounds_of(context_));
      if (fits(again, rig_)) return again;
    } catch (const Error&) {  // no flat surfaces from there
    }
    return std::nullopt;
  }

  const Refinement& refined_;
  const estimate::Sample& sample_;
  const Calibration& start_;
  const RefinementSettings& settings_;
  Context& context_;
  const Rig& rig_;
};

}  // namespace

estimate::RoundReporter rounds_of(Context& context) {
  return [&context](int round) {
    context.progress(static_cast<double>(round) / (round + 4), fmt::format("round {}", round + 1));
    return !context.interrupted();
  };
}

std::optional<Refinement> refined_from_another_start(const Refinement& refined,
                                                     const estimate::Sample& sample, const Calibration& start,
                                                     const RefinementSettings& settings, Context& context) {
  if (refined.views.empty()) return std::nullopt;
  if (agrees_well(refined) && !contradicts_rig(refined, context.rig())) return std::nullopt;
  Restart restart(refined, sample, start, settings, context);
  auto again = restart.from_nominal_values();
  return again ? std::move(again) : restart.one_by_one();
}

}  // namespace crisp::calibrate
