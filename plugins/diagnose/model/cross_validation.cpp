// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/cross_validation.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include <crisp/rqe.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/recordings.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "pipeline/statistics/random_stream.hpp"
#include "pipeline/statistics/weighted_mean.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"

namespace crisp::diagnose {
namespace {

using Sums = CrossValidator::Score::Sums;

constexpr double kMinTurns = 4;
constexpr double kMinPieces = 8;
constexpr std::uint32_t kPiecesPerTurn = 8;
constexpr double kNarrow = 15 * data::kDegree;  // a quarter of the shortest harmonic's period

/// Turn of the plate and recording of each beam.
struct Pieces {
  std::vector<std::uint32_t> turn;  ///< from 0, in order of time; no turn spans two recordings
  std::vector<std::uint32_t> part;  ///< of kPiecesPerTurn of its turn
  std::vector<std::uint32_t> recording;
  bool are_several = false;  ///< more than one recording

  std::uint32_t half(std::size_t i) const { return (are_several ? recording[i] : turn[i]) % 2; }
};

Pieces pieces_of(const estimate::Sample& sample) {
  const data::RecordingNumbers number(*sample.plate);
  Pieces pieces{.turn = {}, .recording = {}, .are_several = number.count() > 1};
  std::vector<double> turned;
  double way = 0;
  double last = 0;
  for (const double time : sample.beams.time) {
    const auto recording = static_cast<std::uint32_t>(number.of(time));
    const auto state = sample.plate->at(time);
    const double angle = state ? state->angle : last;
    const bool goes_on = !turned.empty() && recording == pieces.recording.back();
    if (goes_on) way += std::abs(angle - last);
    last = angle;
    turned.push_back(way);
    pieces.recording.push_back(recording);
  }
  double piece = 2 * std::numbers::pi;
  const bool is_short = way < kMinTurns * piece;
  if (is_short) piece = std::min(kNarrow, way / kMinPieces * (1 + 1e-9));
  std::uint32_t before = 0;  // recording borders so far; each ends a turn
  for (std::size_t i = 0; i < turned.size(); ++i) {
    if (i > 0 && pieces.recording[i] != pieces.recording[i - 1]) ++before;
    const double turns = piece > 0 ? turned[i] / piece : 0;
    pieces.turn.push_back(before + static_cast<std::uint32_t>(turns));
    pieces.part.push_back(is_short ? 0 : static_cast<std::uint32_t>(kPiecesPerTurn * turns) % kPiecesPerTurn);
  }
  return pieces;
}

/// Mean residual of each surface by laser, and by laser and side (front, back).
class ViewMeans {
 public:
  ViewMeans(std::span<const std::uint32_t> members, const std::vector<quality::SurfelResidual>& residuals,
            const quality::BeamsView& beams) {
    for (std::size_t k = 0; k < members.size(); ++k) {
      const std::uint32_t view = beams.views[members[k]];
      const double weight = residuals[k].weight / std::pow(residuals[k].spread, 2);
      lasers_[view / 2].add(residuals[k].distance, weight);
      sides_[view].add(residuals[k].distance, weight);
    }
  }

  /// Adds one beam's contribution to its piece's sums.
  void add(const quality::SurfelResidual& r, std::uint32_t view, double noise, Sums& sums) const {
    const double laser = lasers_.at(view / 2).value();
    const double spread = r.spread * noise;
    sums.weight += r.weight;
    sums.squares += r.weight * r.distance * r.distance;
    sums.likelihood -= r.weight * (std::pow(r.distance / spread, 2) / 2 +
                                   std::log(spread * std::sqrt(2 * std::numbers::pi)));
    sums.lasers += r.weight * laser * laser;
    sums.sides += r.weight * std::pow(sides_.at(view).value() - laser, 2);
  }

 private:
  std::map<std::uint32_t, statistics::Mean> lasers_;
  std::map<std::uint32_t, statistics::Mean> sides_;
};

double ratio(const std::vector<Sums>& pieces, const std::vector<std::size_t>& drawn, double Sums::*part) {
  double sum = 0;
  double weight = 0;
  for (const std::size_t p : drawn) {
    sum += pieces[p].*part;
    weight += pieces[p].weight;
  }
  return weight > 0 ? sum / weight : 0;
}

struct Metric {
  const char* name;
  const char* unit;
  double Sums::*part;
  bool is_square;
};
constexpr std::array kMetrics = {
    Metric{"cloud thickness", "m", &Sums::squares, true},
    Metric{"disagreement of lasers", "m", &Sums::lasers, true},
    Metric{"disagreement of front and back", "m", &Sums::sides, true},
    Metric{CrossValidator::kLikelihood, "nat", &Sums::likelihood, false},
};
constexpr Metric kEntropy = {"RQE", "nat", &Sums::entropy, false};

double value_of(const Metric& metric, const std::vector<Sums>& pieces,
                const std::vector<std::size_t>& drawn) {
  const double mean = ratio(pieces, drawn, metric.part);
  return metric.is_square ? std::sqrt(std::max(0.0, mean)) : mean;
}

/// Pieces of a recording, drawn with replacement many times.
class Resampling {
 public:
  /// @param pieces  those without weight are left out
  explicit Resampling(const std::vector<Sums>& pieces) {
    constexpr std::size_t kDraws = 1000;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      if (pieces[p].weight > 0) all_.push_back(p);
    }
    if (!is_possible()) return;
    // A fixed seed: every metric gets the same bootstrap samples.
    statistics::RandomStream random(all_.size(), "turns");
    draws_.assign(kDraws, std::vector<std::size_t>(all_.size()));
    for (auto& drawn : draws_) {
      for (auto& piece : drawn) piece = all_[random.below(all_.size())];
    }
  }

  bool is_possible() const { return all_.size() > 1; }

  Gain gain(const Metric& metric, const std::vector<Sums>& before, const std::vector<Sums>& after) const {
    const auto count = static_cast<double>(all_.size());
    const double wider = quantile(boost::math::students_t(count - 1), 0.975) * std::sqrt(count / (count - 1));
    const double first = value_of(metric, before, all_);
    const double second = value_of(metric, after, all_);
    double squares = 0;
    for (const auto& drawn : draws_) {
      const double change = value_of(metric, after, drawn) - value_of(metric, before, drawn);
      squares += std::pow(change - (second - first), 2);
    }
    const double half = wider * std::sqrt(squares / static_cast<double>(draws_.size()));
    return {.metric = metric.name,
            .unit = metric.unit,
            .before = first,
            .after = second,
            .ci95 = {second - first - half, second - first + half}};
  }

 private:
  std::vector<std::size_t> all_;
  std::vector<std::vector<std::size_t>> draws_;
};

}  // namespace

Halves halves_of(const estimate::Sample& sample, std::uint32_t held_out) {
  const Pieces pieces = pieces_of(sample);
  const auto is_held_out = [&](std::size_t i) { return pieces.half(i) == held_out; };
  Halves halves;
  halves.fitted = estimate::select(sample, [&](std::size_t i) { return !is_held_out(i); });
  halves.held_out = estimate::select(sample, is_held_out);
  for (std::size_t i = 0; i < pieces.turn.size(); ++i) {
    if (!is_held_out(i)) continue;
    halves.turn.push_back(pieces.turn[i]);
    halves.piece.push_back(kPiecesPerTurn * pieces.turn[i] + pieces.part[i]);
  }
  return halves;
}

void CrossValidator::Score::append(const Score& other) {
  pieces.insert(pieces.end(), other.pieces.begin(), other.pieces.end());
  turns.insert(turns.end(), other.turns.begin(), other.turns.end());
}

CrossValidator::CrossValidator(Halves halves, const std::vector<SensorModel>& choosers,
                               const quality::SurfelSettings& settings)
    : halves_(std::move(halves)), settings_(settings) {
  for (const SensorModel& chooser : choosers) choices_.push_back(choice_of(chooser));
}

CrossValidator::Choice CrossValidator::choice_of(const SensorModel& chooser) const {
  constexpr std::size_t kBeams = 200'000;
  const SurfaceObservations observations(chooser, halves_.held_out, {.surfels = settings_}, kBeams);
  const auto reported = observations.beams().noise;
  Choice choice{.held_out = halves_.held_out,
                .surfels = observations.surfels(),
                .reference = observations.placed(),
                .given_noise = {reported.begin(), reported.end()}};
  choice.held_out.beams.cos_incidence = observations.sample().beams.cos_incidence;
  double squares = 0;
  double weight = 0;
  for (const quality::Surfel& surfel : choice.surfels.surfels) {
    for (const quality::SurfelResidual& r :
         quality::residuals_of(surfel, choice.surfels, observations.beams(), settings_)) {
      squares += r.weight * std::pow(r.distance / r.spread, 2);
      weight += r.weight;
    }
  }
  choice.noise = std::sqrt(squares / std::max(1.0, weight));
  return choice;
}

CrossValidator::Score CrossValidator::score(const SensorModel& model) const {
  Score score;
  const std::size_t turns = halves_.turn.empty() ? 0 : std::ranges::max(halves_.turn) + std::size_t{1};
  score.turns.resize(turns);
  score.pieces.resize(kPiecesPerTurn * turns);
  for (const Choice& choice : choices_) add(choice, model, score);
  return score;
}

/// Adds the sums of the model on one chooser's surfaces.
void CrossValidator::add(const Choice& choice, const SensorModel& model, Score& score) const {
  estimate::PlacedBeams placed(model, choice.held_out);
  placed.align_with(choice.reference, choice.held_out);
  const quality::BeamsView beams = placed.view(choice.given_noise);
  std::vector<Vectors> clouds(score.turns.size());
  std::vector<double> weights(score.turns.size());
  for (const quality::Surfel& surfel : choice.surfels.surfels) {
    const auto members = choice.surfels.beams_of(surfel);
    const auto residuals = quality::residuals_of(surfel, choice.surfels, beams, settings_);
    const ViewMeans views(members, residuals, beams);
    for (std::size_t k = 0; k < members.size(); ++k) {
      const std::size_t i = members[k];
      if (residuals[k].weight == 0) continue;
      views.add(residuals[k], beams.views[i], choice.noise, score.pieces[halves_.piece[i]]);
      weights[halves_.turn[i]] += residuals[k].weight;
      Vectors& cloud = clouds[halves_.turn[i]];
      cloud.x.push_back(beams.points.x[i]);
      cloud.y.push_back(beams.points.y[i]);
      cloud.z.push_back(beams.points.z[i]);
    }
  }
  for (std::size_t t = 0; t < clouds.size(); ++t) {
    if (clouds[t].x.empty()) continue;
    const Rqe entropy = rqe(clouds[t].view(), {}, {.sigma = 0.02, .cutoff = 5, .gradient = false});
    score.turns[t].weight += weights[t];
    score.turns[t].entropy += weights[t] * entropy.value;
  }
}

std::vector<Gain> CrossValidator::gains(const Score& before, const Score& after) {
  const Resampling pieces(before.pieces);
  const Resampling turns(before.turns);
  std::vector<Gain> gains;
  if (!pieces.is_possible()) return gains;
  for (const Metric& metric : kMetrics) gains.push_back(pieces.gain(metric, before.pieces, after.pieces));
  if (turns.is_possible()) gains.push_back(turns.gain(kEntropy, before.turns, after.turns));
  return gains;
}

}  // namespace crisp::diagnose
