// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/recording_proposals.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "pipeline/estimate/incidence.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/model/predicted_recording.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kRevolution = 2 * std::numbers::pi;

/// Another motion of the plate, or another standpoint.
struct Plan {
  std::string recording;
  std::vector<double> angles;  ///< [rad] one for each reading of the encoder
  Standpoint standpoint = {};
};

/// [rad/s] Mean of the rate's amount.
double mean_rate(const PlateTrajectory& plate) {
  double rate = 0;
  for (const double one : plate.rates()) rate += std::abs(one) / static_cast<double>(plate.size());
  return rate;
}

/// [rad] The plate's angle at each reading.
///
/// @param turned  [rad] since the first reading, of the time [s] since then
std::vector<double> angles_by(const PlateTrajectory& plate, const std::function<double(double)>& turned) {
  std::vector<double> angles;
  for (const double time : plate.times())
    angles.push_back(plate.angles().front() + turned(time - plate.times().front()));
  return angles;
}

/// To and fro by more than a turn, so that all is seen.
Plan to_and_fro(const PlateTrajectory& plate, double rate) {
  constexpr double kFaster = 1.5;     // at most, than the mean rate
  constexpr double kSwing = 0.6;      // [turns] least amplitude
  constexpr double kShortPeriod = 4;  // [s]
  const double peak = kFaster * rate;
  const double period = std::max(kShortPeriod, kRevolution * kSwing * kRevolution / peak);
  return {.recording = fmt::format("the plate turning to and fro, at up to {:.2g} Hz", peak / kRevolution),
          .angles = angles_by(plate, [&](double t) {
            return peak * period / kRevolution * std::sin(kRevolution * t / period);
          })};
}

Plan at_varying_rate(const PlateTrajectory& plate, double rate) {
  constexpr double kVariation = 0.8;  // of the mean rate
  constexpr double kPeriod = 4;       // [s]
  return {.recording = fmt::format("the plate's rate varying between {:.2g} and {:.2g} Hz every {:g} s",
                                   (1 - kVariation) * rate / kRevolution,
                                   (1 + kVariation) * rate / kRevolution, kPeriod),
          .angles = angles_by(plate, [&](double t) {
            return rate * (t - kVariation * kPeriod / kRevolution * std::cos(kRevolution * t / kPeriod));
          })};
}

Plan tilted(const std::vector<double>& recorded) {
  constexpr double kTilt = 30 * data::kDegree;
  return {.recording = "the scanner tilted by 30 degrees in the same place",
          .angles = recorded,
          .standpoint = {.attitude = Eigen::AngleAxisd(kTilt, Eigen::Vector3d::UnitX()).toRotationMatrix()}};
}

/// In a hall if this was a room, and the other way round.
Plan in_another_place(const std::vector<double>& recorded, std::vector<float> ranges) {
  constexpr double kLarge = 5;  // [m] half of a large place's ranges are longer
  constexpr double kTimes = 3;
  const bool is_large = statistics::quantile_in_place(ranges, 0.5) > kLarge;
  return {
      .recording = fmt::format("another place, with surfaces {} as far", is_large ? "a third" : "3 times"),
      .angles = recorded,
      .standpoint = {.distance = is_large ? 1 / kTimes : kTimes}};
}

std::vector<Plan> plans(const estimate::Sample& sample) {
  constexpr double kResting = 1e-3;  // [rad/s]
  const PlateTrajectory& plate = *sample.plate;
  const std::vector<double> recorded(plate.angles().begin(), plate.angles().end());
  const double rate = mean_rate(plate);
  std::vector<Plan> all = {tilted(recorded), in_another_place(recorded, sample.beams.range)};
  if (rate < kResting) return all;
  all.push_back(to_and_fro(plate, rate));
  all.push_back(at_varying_rate(plate, rate));
  all.push_back({.recording = fmt::format("the plate at twice the rate ({:.2g} Hz)", 2 * rate / kRevolution),
                 .angles = recorded});
  for (double& angle : all.back().angles) angle += angle - recorded.front();
  return all;
}

bool is_shared_by_recordings(const Candidate& candidate, const TermRegistry& terms) {
  constexpr Coverage kOfTwo{.one_begin = false, .one_zero = false};
  return kOfTwo.shares(terms.get(candidate.term.term)->info().counts_from);
}

/// Fisher's information of predicted recordings, as if they had as many beams as the recorded one.
class Predictor {
 public:
  Predictor(const SensorModel& model, const std::vector<std::size_t>& base,
            const SurfaceObservations& observations, const TermRegistry& terms,
            const DiagnosisSettings& settings)
      : model_(model), observations_(observations), terms_(terms), settings_(settings) {
    constexpr std::size_t kBeams = 40'000;
    constexpr std::uint64_t kSeed = 1;
    const estimate::Sample longest = estimate::longest_recording(observations.sample());
    recorded_ = longest.beams.size();
    pattern_ = estimate::thin_evenly(longest, kBeams, kSeed);
    std::vector<Candidate> causes =
        typical_causes(candidates(terms, model.calibration(), observations.coverage()));
    std::erase_if(causes, [&](const Candidate& one) { return settings.excluded.contains(one.name); });
    jacobian_.emplace(model, base, std::move(causes), terms);
    const auto angles = pattern_.plate->angles();
    here_ = equations_of({.recording = {}, .angles = {angles.begin(), angles.end()}});
  }

  /// Of the recording by itself for causes that recordings do not share, of both together for all others.
  std::vector<EffectResolution> resolutions(const Plan& plan) const {
    const auto planned = equations_of(plan);
    if (!planned) return {};
    const auto is_shared = [&](const Candidate& one) { return is_shared_by_recordings(one, terms_); };
    const auto is_everything_shared = std::ranges::all_of(
        jacobian_->candidates(), [&](const Candidate& one) { return !one.in_model || is_shared(one); });
    if (!here_ || !is_everything_shared) return effect_resolutions(*jacobian_, *planned, settings_.selection);
    auto all = effect_resolutions(*jacobian_, *planned, settings_.selection, std::not_fn(is_shared));
    const auto together =
        effect_resolutions(*jacobian_, joint(*here_, *planned), settings_.selection, is_shared);
    all.insert(all.end(), together.begin(), together.end());
    return all;
  }

  const estimate::Sample& pattern() const { return pattern_; }

 private:
  /// None if the beams meet none of the surfaces.
  std::optional<quality::NormalEquations> equations_of(const Plan& plan) const {
    PredictedRecording recording = predicted_recording(model_, pattern_, observations_.beams(),
                                                       observations_.surfels(), plan.angles, plan.standpoint);
    const estimate::PlacedBeams placed(model_, recording.sample());
    quality::reject_grazed(recording.surfels, placed.view());
    if (recording.surfels.surfels.empty()) return {};
    recording.beams.cos_incidence = estimate::incidences(recording.surfels, placed.view());
    const estimate::Sample sample = recording.sample();
    const std::array one_block = {quality::Division(sample.beams.size(), 0)};
    quality::NormalEquations equations =
        quality::normal_equations(recording.surfels, placed.view(), jacobian_->parameters(),
                                  jacobian_->rows(sample), settings_.refinement.surfels, one_block);
    if (!(equations.degrees_of_freedom > 0)) return {};
    const double met = static_cast<double>(sample.beams.size()) / static_cast<double>(pattern_.beams.size());
    const double beams = std::min(met * static_cast<double>(recorded_), static_cast<double>(settings_.beams));
    quality::NormalEquations planned = planned_with(std::move(equations), beams);
    jacobian_->add_prior(planned, settings_.refinement.prior);
    planned.vector.setZero();
    planned.chi2 = 0;
    return planned;
  }

  /// Of both recordings together. Lags and skews of clocks are each recording's own.
  quality::NormalEquations joint(const quality::NormalEquations& one,
                                 const quality::NormalEquations& other) const {
    std::vector<std::size_t> own;
    for (std::size_t column = 0; column < jacobian_->base(); ++column) {
      const std::string& name = jacobian_->names()[column];
      if (name.ends_with(".eta") || name.ends_with(".skew")) own.push_back(column);
    }
    quality::NormalEquations both = without(own, one);
    both += without(own, other);
    const double beams = std::min(static_cast<double>(both.beams), static_cast<double>(settings_.beams));
    return planned_with(std::move(both), beams);
  }

  /// Projects parameters out and leaves them as known.
  static quality::NormalEquations without(const std::vector<std::size_t>& parameters,
                                          const quality::NormalEquations& equations) {
    std::vector<std::size_t> all(static_cast<std::size_t>(equations.vector.size()));
    std::iota(all.begin(), all.end(), std::size_t{0});
    quality::NormalEquations left = equations.reduced(all, parameters);
    for (const std::size_t each : parameters) {
      const auto i = static_cast<Eigen::Index>(each);
      left.matrix.row(i).setZero();
      left.matrix.col(i).setZero();
      left.matrix(i, i) = equations.matrix(i, i);
    }
    return left;
  }

  const SensorModel& model_;
  const SurfaceObservations& observations_;
  const TermRegistry& terms_;
  const DiagnosisSettings& settings_;
  std::size_t recorded_ = 0;
  estimate::Sample pattern_;
  std::optional<CandidateJacobian> jacobian_;
  std::optional<quality::NormalEquations> here_;  ///< of the recorded motion and standpoint
};

/// A proposal's resolution of a cause; a default one, without finite sizes, if it has none.
EffectResolution resolution_of(const RecordingProposal& proposal, const std::string& cause) {
  const auto found = std::ranges::find(proposal.effects, cause, &EffectResolution::cause);
  return found == proposal.effects.end() ? EffectResolution{} : *found;
}

}  // namespace

std::vector<RecordingProposal> propose_recordings(const SensorModel& model,
                                                  const std::vector<std::size_t>& base,
                                                  const SurfaceObservations& observations,
                                                  const TermRegistry& terms,
                                                  const DiagnosisSettings& settings) {
  const Predictor predictor(model, base, observations, terms, settings);
  std::vector<RecordingProposal> proposals;
  for (const Plan& plan : plans(predictor.pattern())) {
    if (settings.interrupted && settings.interrupted()) throw Interrupted();
    proposals.push_back({.recording = plan.recording, .effects = predictor.resolutions(plan)});
  }
  return proposals;
}

std::vector<std::string> resolving(const std::vector<RecordingProposal>& proposals, const std::string& cause,
                                   double size) {
  std::vector<std::pair<double, std::string>> all;
  for (const RecordingProposal& proposal : proposals) {
    const double from = resolution_of(proposal, cause).resolvable;
    if (std::isfinite(from))
      all.emplace_back(from, fmt::format("{} (predicted: from {:.2g} mm on; here it is {:.2g} mm)",
                                         proposal.recording, 1e3 * from, 1e3 * size));
  }
  std::ranges::sort(all);
  const auto enough = std::ranges::count_if(all, [&](const auto& one) { return one.first < size; });
  all.resize(std::min(all.size(), std::max<std::size_t>(1, static_cast<std::size_t>(enough))));
  std::vector<std::string> words;
  for (auto& [from, text] : all) words.push_back(std::move(text));
  return words;
}

std::string showing(const std::vector<RecordingProposal>& proposals, const std::string& cause, double limit) {
  constexpr double kMuchLess = 0.5;
  std::string words;
  double least = kMuchLess * limit;
  for (const RecordingProposal& proposal : proposals) {
    const double from = resolution_of(proposal, cause).detectable;
    if (!(from < least)) continue;
    least = from;
    words = fmt::format("{} (predicted: detectable from {:.2g} mm on)", proposal.recording, 1e3 * from);
  }
  return words;
}

}  // namespace crisp::diagnose
