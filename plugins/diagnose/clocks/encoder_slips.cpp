// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/encoder_slips.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "pipeline/statistics/random_stream.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/clocks/angle_shift_regression.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kBlock = AngleShiftModel::kBlock;
constexpr std::size_t kMaxSlips = 100;

std::int64_t block_of(double time) { return AngleShiftModel::block_of(time); }

/// Starts of blocks with enough blocks of shifts across them on either side: with few clusters, clustered
/// standard errors are too small (Cameron, Gelbach and Miller 2008).
std::set<std::int64_t> supported_blocks(std::span<const AngleShift> shifts) {
  constexpr std::size_t kMin = 8;
  std::map<std::int64_t, std::pair<std::set<std::int64_t>, std::set<std::int64_t>>> sides;
  for (const AngleShift& shift : shifts) {
    for (std::int64_t begin = block_of(shift.earlier) + 1; begin <= block_of(shift.later); ++begin) {
      sides[begin].first.insert(block_of(shift.earlier));
      sides[begin].second.insert(block_of(shift.later));
    }
  }
  std::set<std::int64_t> supported;
  for (const auto& [begin, side] : sides) {
    if (side.first.size() >= kMin && side.second.size() >= kMin) supported.insert(begin);
  }
  return supported;
}

/// Candidate time of a step.
struct StepCandidate {
  double time = 0;  // [s since epoch]
  double gain = 0;  // decrease of the weighted squares of the residuals (score test)
  bool is_supported = false;
};

/// Whether a time is so near to a slip that the shifts do not resolve a second one.
bool is_near(std::span<const EncoderSlip> slips, double time) {
  constexpr double kApart = 2.5 * kBlock;
  return std::ranges::any_of(slips,
                             [&](const EncoderSlip& slip) { return std::abs(slip.at - time) < kApart; });
}

/// The supported candidate of the largest gain, and all others of similar gain. A plate that reverses passes
/// its angles in the opposite order, so two times then explain the same shifts.
std::vector<StepCandidate> best_candidates(const AngleShiftModel& model,
                                           const std::set<std::int64_t>& supported,
                                           std::span<const EncoderSlip> known) {
  constexpr double kNear = 0.3;  // of the largest gain
  constexpr double kMin = 2;     // shifts
  std::vector<StepCandidate> candidates;
  double best = 0;  // largest gain of a supported candidate
  for (const AngleShiftModel::StepScore& score : model.step_scores()) {
    const double time = kBlock * static_cast<double>(score.block);
    if (score.shifts < kMin || is_near(known, time)) continue;
    const bool is_supported = supported.contains(score.block);
    candidates.push_back({.time = time, .gain = score.gain, .is_supported = is_supported});
    if (is_supported) best = std::max(best, score.gain);
  }
  std::erase_if(candidates,
                [&](const StepCandidate& each) { return !(each.gain > kNear * best) || best == 0; });
  std::ranges::sort(candidates, [](const StepCandidate& a, const StepCandidate& b) {
    return std::pair(a.is_supported, a.gain) > std::pair(b.is_supported, b.gain);
  });
  return candidates;
}

/// Time near `time` at which the readings step by about `size`, faster than a plate can turn.
std::optional<EncoderSlip> step_in_readings(double time, double size, const PlateTrajectory& plate) {
  constexpr double kAround = 2.5 * kBlock;
  constexpr std::size_t kClear = 3;  // readings on either side, whose rates the step does not affect
  constexpr double kMin = 0.5;       // relative to the size
  constexpr double kMax = 2;
  const auto times = plate.times();
  const auto first =
      static_cast<std::size_t>(std::ranges::lower_bound(times, time - kAround) - times.begin());
  std::optional<EncoderSlip> slip;
  double largest = kMin;
  for (std::size_t n = std::max(first, kClear); n + kClear + 1 < times.size(); ++n) {
    if (times[n] > time + kAround) break;
    const double width = times[n + 1] - times[n];
    const double rate = 0.5 * (plate.rates()[n - kClear] + plate.rates()[n + 1 + kClear]);
    const double step = (plate.angles()[n + 1] - plate.angles()[n] - rate * width) / size;
    if (step <= largest || step > kMax) continue;
    largest = step;
    slip = EncoderSlip{.at = 0.5 * (times[n] + times[n + 1]),
                       .at_std_error = width / std::sqrt(12.0),
                       .is_in_readings = true};
  }
  return slip;
}

/// Combines the size of a slip that shows in the readings with their own step: that of a parabola with a step
/// (least squares), where the plate turns so smoothly that the encoder's steps are all that is left.
void sharpen(EncoderSlip& slip, const PlateTrajectory& plate, double angle_step) {
  constexpr std::ptrdiff_t kAround = 12;  // readings on either side
  constexpr double kSmooth = 1.5;         // [errors of rounding to a step]
  const auto times = plate.times();
  const auto middle = std::ranges::upper_bound(times, slip.at) - times.begin();
  const auto end = static_cast<std::ptrdiff_t>(times.size());
  if (!slip.is_in_readings || middle < kAround || middle + kAround > end) return;
  Eigen::Matrix<double, 2 * kAround, 4> rows;
  Eigen::Matrix<double, 2 * kAround, 1> angles;
  for (std::ptrdiff_t k = 0; k < 2 * kAround; ++k) {
    const auto n = static_cast<std::size_t>(middle - kAround + k);
    const double time = times[n] - slip.at;
    rows.row(k) << 1, time, time * time, times[n] > slip.at ? 1 : 0;
    angles[k] = plate.angles()[n];
  }
  const Eigen::Matrix4d inverse = (rows.transpose() * rows).inverse();
  const Eigen::Vector4d fit = inverse * (rows.transpose() * angles);
  const double rounding = angle_step / std::sqrt(12.0);
  const double left = (angles - rows * fit).norm() / std::sqrt(2.0 * kAround - 4);
  if (left > kSmooth * rounding) return;
  const double variance = std::pow(std::max(left, rounding), 2) * inverse(3, 3);
  const double own = slip.by_std_error * slip.by_std_error;
  slip.by = (slip.by * variance + fit[3] * own) / (variance + own);
  slip.by_std_error = std::sqrt(variance * own / (variance + own));
}

/// A slip of this size at the best candidate that shows in the readings, otherwise at the first candidate.
EncoderSlip located(const std::vector<StepCandidate>& candidates, double size, const PlateTrajectory& plate,
                    double angle_step) {
  constexpr double kClear = 2.5;  // encoder steps; smaller slips are not distinct in the readings
  for (const StepCandidate& candidate : candidates) {
    if (std::abs(size) < kClear * angle_step) break;
    if (const auto slip = step_in_readings(candidate.time, size, plate)) return *slip;
  }
  const auto [first, last] = std::ranges::minmax(candidates, {}, &StepCandidate::time);
  return {.at = candidates.front().time, .at_std_error = std::max(kBlock, (last.time - first.time) / 2)};
}

/// Whether the slip shows in the readings, or exceeds what poorly overlapping scans can produce.
bool is_significant(const EncoderSlip& slip) {
  const double smallest = (slip.is_in_readings ? 0.1 : 0.5) * data::kDegree;
  const double errors = slip.is_in_readings ? 6 : 10;
  const double size = std::abs(slip.by);
  return size > smallest && size > errors * slip.by_std_error;
}

/// One search on shifts measured without the slips of `found`.
class SlipSearch {
 public:
  SlipSearch(std::span<const AngleShift> shifts, double angle_step, std::vector<EncoderSlip>& found)
      : angle_step_(angle_step),
        found_(found),
        model_(shifts, times_of(found)),
        supported_(supported_blocks(shifts)) {
    for (const EncoderSlip& slip : found) before_.push_back(slip.by);
  }

  /// @param plate  without the slips found so far
  /// @return  whether slips were added or removed
  bool run(const PlateTrajectory& plate) {
    const std::size_t known = found_.size();
    update();
    while (found_.size() < kMaxSlips) {
      const auto candidates = best_candidates(model_, supported_, found_);
      if (candidates.empty()) break;
      AngleShiftModel trial = model_;
      trial.add(candidates.front().time);
      const double size = trial.size(trial.steps() - 1);
      const EncoderSlip slip = located(candidates, size, plate, angle_step_);
      if (is_near(found_, slip.at)) break;
      add(slip);
      if (is_significant(found_.back())) continue;
      remove(found_.size() - 1);
      break;
    }
    bool is_changed = found_.size() != known;
    for (std::size_t k = found_.size(); k-- > 0;) {
      if (is_significant(found_[k])) continue;
      remove(k);
      is_changed = true;
    }
    return is_changed;
  }

  const AngleShiftModel& model() const { return model_; }
  double tested() const { return kBlock * static_cast<double>(supported_.size()); }  // [s]

 private:
  static std::vector<double> times_of(const std::vector<EncoderSlip>& slips) {
    std::vector<double> times;
    for (const EncoderSlip& slip : slips) times.push_back(slip.at);
    return times;
  }

  void add(const EncoderSlip& slip) {
    model_.add(slip.at);
    found_.push_back(slip);
    before_.push_back(0);
    update();
  }

  void remove(std::size_t k) {
    model_.remove(k);
    found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(k));
    before_.erase(before_.begin() + static_cast<std::ptrdiff_t>(k));
    update();
  }

  void update() {
    for (std::size_t k = 0; k < found_.size(); ++k) {
      EncoderSlip& slip = found_[k];
      slip.by = before_[k] + model_.size(k);
      slip.by_std_error = model_.std_error(k);
      const double z = std::abs(slip.by) / slip.by_std_error;
      const double tests = 2 * static_cast<double>(supported_.size());
      slip.p_value = std::min(1.0, tests * cdf(complement(boost::math::normal(), z)));
    }
  }

  double angle_step_ = 0;
  std::vector<EncoderSlip>& found_;
  std::vector<double> before_;  // [rad] part of each slip that the shifts were measured without
  AngleShiftModel model_;
  std::set<std::int64_t> supported_;
};

/// Block bootstrap of the change in RMS; {squares before, squares after, number} per block.
std::array<double, 2> interval_of_change(const std::vector<std::array<double, 3>>& blocks,
                                         std::uint64_t seed) {
  constexpr std::size_t kDraws = 1000;
  statistics::RandomStream random(seed, "slips");
  std::vector<double> changes(kDraws);
  for (double& change : changes) {
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const auto& block = blocks[random.below(blocks.size())];
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += block[c];
    }
    change = std::sqrt(sum[1] / sum[2]) - std::sqrt(sum[0] / sum[2]);
  }
  constexpr double kTail = 0.025;
  const double low = statistics::quantile_in_place(changes, kTail);
  return {low, statistics::quantile_in_place(changes, 1 - kTail)};
}

/// @param removed  slips already removed from the shifts
void measure_gain(std::vector<AngleShift> shifts, std::span<const EncoderSlip> removed,
                  const AngleShiftModel& after, std::uint64_t seed, EncoderSlips& result) {
  for (AngleShift& shift : shifts) {
    for (const EncoderSlip& slip : removed) shift.shift += is_across(shift, slip.at) ? slip.by : 0;
  }
  const AngleShiftModel before(shifts, {});
  std::map<std::int64_t, std::array<double, 3>> blocks;
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    auto& block = blocks[block_of(shifts[i].later)];
    block[0] += before.residuals()[k] * before.residuals()[k];
    block[1] += after.residuals()[k] * after.residuals()[k];
    block[2] += 1;
  }
  const double root = std::sqrt(static_cast<double>(shifts.size()));
  result.rms_before = before.residuals().norm() / root;
  result.rms_after = after.residuals().norm() / root;
  std::vector<std::array<double, 3>> sums;
  for (const auto& [number, block] : blocks) sums.push_back(block);
  result.ci95 = interval_of_change(sums, seed);
}

}  // namespace

EncoderSlips find_encoder_slips(const Measurements& beams, const PlateTrajectory& plate, double angle_step,
                                std::uint64_t seed) {
  constexpr std::size_t kMin = 20;  // shifts
  constexpr int kRounds = 6;
  EncoderSlips result;
  PlateTrajectory corrected = plate;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<AngleShift> shifts = angle_shifts(beams, corrected);
    result.shifts = shifts.size();
    if (shifts.size() < kMin) return result;
    const std::vector<EncoderSlip> removed = result.slips;
    SlipSearch search(shifts, angle_step, result.slips);
    result.tested = search.tested();
    if (!search.run(corrected) || round + 1 == kRounds) {
      measure_gain(shifts, removed, search.model(), seed, result);
      break;
    }
    corrected = without_slips(plate, result.slips);
  }
  for (EncoderSlip& slip : result.slips) sharpen(slip, plate, angle_step);
  std::ranges::sort(result.slips, {}, &EncoderSlip::at);
  return result;
}

PlateTrajectory without_slips(const PlateTrajectory& plate, std::span<const EncoderSlip> slips) {
  std::vector<double> angles(plate.angles().begin(), plate.angles().end());
  for (const EncoderSlip& slip : slips) {
    for (std::size_t i = 0; i < angles.size(); ++i) {
      if (plate.times()[i] > slip.at) angles[i] -= slip.by;
    }
  }
  return plate.with_angles(std::move(angles));
}

}  // namespace crisp::diagnose
