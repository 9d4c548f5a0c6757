// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/angle_shifts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/recordings.hpp"
#include "pipeline/quality/blocks.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr std::size_t kBeams = 64;                   // beams compared per scan
constexpr double kReach = 20 * data::kDegree;        // largest shift tested
constexpr double kShiftStep = 0.25 * data::kDegree;  // grid of shifts
constexpr std::size_t kShifts = 161;
constexpr std::size_t kScans = 5;    // per block
constexpr double kGap = 2.5;         // [scan periods] largest gap between neighbouring scans
constexpr double kTruncated = 0.15;  // [m] truncation of range differences
constexpr double kApart = 1.5;       // [blocks] minimum distance of compared scans
constexpr std::size_t kPasses = 4;   // earlier passes compared with a scan

/// Systematic subsample of the beams of one scan.
struct ScanLine {
  double time = 0;   // [s since epoch] of the middle beam with an angle
  double angle = 0;  // [rad] plate angle at that time, unwrapped
  double rate = 0;   // [rad/s]
  std::size_t recording = 0;
  std::array<double, kBeams> angles{};  // [rad] plate angle at each beam's time
  std::array<float, kBeams> ranges{};   // [m]; 0: no echo
};

/// Sums of truncated range differences by shift.
struct Cost {
  std::array<double, kShifts> sum{};
  std::array<double, kShifts> count{};
  double weight = 0;
  AngleShift mean;  // weighted sums, divided by the weight in the end

  void add(const ScanLine& later, const ScanLine& earlier) {
    ++weight;
    mean.later += later.time;
    mean.earlier += earlier.time;
    mean.rate_later += later.rate;
    mean.rate_earlier += earlier.rate;
  }
};

class ScanLines {
 public:
  ScanLines(const Measurements& beams, const PlateTrajectory& plate, std::size_t laser) {
    const data::RecordingNumbers recordings(plate);
    std::size_t most = 0;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (beams.laser[i] == laser) most = std::max<std::size_t>(most, beams.beam[i]);
    }
    const std::size_t stride = most / kBeams + 1;
    std::size_t last = most + 1;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (beams.laser[i] != laser) continue;
      const std::size_t beam = beams.beam[i];
      if (beam <= last) lines_.emplace_back();
      last = beam;
      if (beam % stride != 0) continue;
      const auto state = plate.at(beams.time[i]);
      if (!state) continue;
      ScanLine& line = lines_.back();
      line.angles[beam / stride] = state->angle;
      line.ranges[beam / stride] = beams.range[i];
      if (line.time > 0 && beam > most / 2) continue;
      line.time = beams.time[i];
      line.angle = state->angle;
      line.rate = state->rate;
      line.recording = recordings.of(line.time);
    }
    std::erase_if(lines_, [](const ScanLine& line) { return line.time == 0; });
    if (lines_.size() < 2) return;
    std::vector<double> periods;
    for (std::size_t j = 1; j < lines_.size(); ++j) periods.push_back(lines_[j].time - lines_[j - 1].time);
    period_ = statistics::median_in_place(periods);
    index_by_angle();
  }

  std::size_t size() const { return lines_.size(); }
  double block() const { return static_cast<double>(kScans) * period_; }  // [s]
  const ScanLine& operator[](std::size_t i) const { return lines_[i]; }

  /// Scans at which the plate last passed the angle of scan i, the latest first.
  std::vector<std::size_t> earlier_passes(std::size_t i) const {
    const ScanLine& line = lines_[i];
    std::vector<std::size_t> passes;
    double last = line.time - kApart * block();
    const auto& near = by_angle_[bucket(line.angle)];
    for (auto j = std::lower_bound(near.begin(), near.end(), i);
         j != near.begin() && passes.size() < kPasses;) {
      --j;
      const ScanLine& other = lines_[*j];
      if (other.recording != line.recording) break;
      if (other.time > last) continue;
      passes.push_back(*j);
      last = other.time - kApart * block();
    }
    return passes;
  }

  /// Range of scans around scan j in one direction of the plate, within the largest shift.
  std::pair<std::size_t, std::size_t> sweep_about(std::size_t j, double until) const {
    const double sign = lines_[j + 1].angle > lines_[j].angle ? 1 : -1;
    const auto goes_on = [&](std::size_t k) {  // from k to k + 1
      const double step = sign * (lines_[k + 1].angle - lines_[k].angle);
      return step > 0 && lines_[k + 1].time - lines_[k].time < kGap * period_;
    };
    constexpr double kMargin = 1.2;
    std::size_t first = j;
    std::size_t last = j + 1;
    while (first > 0 && goes_on(first - 1) &&
           std::abs(lines_[first].angle - lines_[j].angle) < kMargin * kReach) {
      --first;
    }
    while (last + 1 < lines_.size() && goes_on(last) && lines_[last + 1].time < until &&
           std::abs(lines_[last].angle - lines_[j].angle) < kMargin * kReach) {
      ++last;
    }
    return {first, last};
  }

 private:
  static constexpr std::size_t kBuckets = 180;

  static std::size_t bucket(double angle) {
    const double turns = angle / kFullTurn;
    return static_cast<std::size_t>((turns - std::floor(turns)) * kBuckets) % kBuckets;
  }

  void index_by_angle() {
    for (std::size_t j = 0; j + 1 < lines_.size(); ++j) {
      const double width = std::abs(lines_[j + 1].angle - lines_[j].angle);
      if (!(width < kReach) || lines_[j + 1].time - lines_[j].time > kGap * period_) continue;
      const double first = std::min(lines_[j].angle, lines_[j + 1].angle);
      std::size_t last = kBuckets;
      for (double at = 0; at <= width; at += kFullTurn / kBuckets / 2) {
        const std::size_t here = bucket(first + at);
        if (here != last) by_angle_[here].push_back(j);
        last = here;
      }
    }
  }

  double period_ = 0;  // [s] between scans
  std::vector<ScanLine> lines_;
  std::vector<std::vector<std::size_t>> by_angle_ = std::vector<std::vector<std::size_t>>(
      kBuckets);  // by angle: scans j, ascending, such that the plate passes the angle between j and j + 1
};

/// Adds the differences of one scan's beams from the ranges of an earlier sweep, first to last.
void compare(const ScanLines& lines, std::size_t i, std::pair<std::size_t, std::size_t> sweep, double turns,
             Cost& cost) {
  const ScanLine& line = lines[i];
  const bool grows = lines[sweep.second].angle > lines[sweep.first].angle;
  const auto count = static_cast<std::ptrdiff_t>(sweep.second - sweep.first);
  for (std::size_t k = 0; k < kBeams; ++k) {
    if (!(line.ranges[k] > 0)) continue;
    // The interpolated angle in the earlier sweep decreases with the shift.
    std::ptrdiff_t at = grows ? count - 1 : 0;
    const auto scan = [&](std::ptrdiff_t m) -> const ScanLine& {
      return lines[sweep.first + static_cast<std::size_t>(m)];
    };
    for (std::size_t s = 0; s < kShifts; ++s) {
      const double shift = -kReach + static_cast<double>(s) * kShiftStep;
      const double requested = line.angles[k] + turns - shift;
      const auto lower = [&](std::ptrdiff_t m) { return scan(grows ? m : m + 1).angles[k]; };
      while (at >= 0 && at < count && lower(at) > requested) at += grows ? -1 : 1;
      if (at < 0 || at >= count) break;
      const ScanLine& a = scan(at);
      const ScanLine& b = scan(at + 1);
      const double width = b.angles[k] - a.angles[k];
      const double share = (requested - a.angles[k]) / width;
      if (!(a.ranges[k] > 0 && b.ranges[k] > 0 && share >= 0 && share <= 1)) continue;
      const double expected =
          std::lerp(static_cast<double>(a.ranges[k]), static_cast<double>(b.ranges[k]), share);
      cost.sum[s] += std::min(kTruncated, std::abs(static_cast<double>(line.ranges[k]) - expected));
      cost.count[s] += 1;
    }
  }
}

/// Shift of least mean cost, refined by a parabola through three grid points.
std::optional<double> minimizer(const Cost& cost) {
  constexpr double kMin = 100;   // comparisons
  constexpr double kDeep = 0.7;  // of the median cost
  std::vector<double> means(kShifts, std::numeric_limits<double>::infinity());
  std::vector<double> known;
  for (std::size_t s = 0; s < kShifts; ++s) {
    if (cost.count[s] < kMin) continue;
    means[s] = cost.sum[s] / cost.count[s];
    known.push_back(means[s]);
  }
  if (known.size() < kShifts / 4) return std::nullopt;
  const auto least = static_cast<std::size_t>(std::ranges::min_element(means) - means.begin());
  if (least < 4 || least + 4 >= kShifts || !(means[least] < kDeep * statistics::median_in_place(known)))
    return std::nullopt;
  const double before = means[least - 1] - means[least];
  const double after = means[least + 1] - means[least];
  if (!std::isfinite(before + after) || !(before + after > 0)) return std::nullopt;
  return -kReach + kShiftStep * (static_cast<double>(least) + 0.5 * (before - after) / (before + after));
}

std::vector<AngleShift> shifts_of(const Measurements& beams, const PlateTrajectory& plate,
                                  std::size_t laser) {
  const ScanLines lines(beams, plate, laser);
  const auto block = [&](double time) { return static_cast<std::int64_t>(std::floor(time / lines.block())); };
  std::map<std::pair<std::int64_t, std::int64_t>, Cost> costs;
  std::vector<AngleShift> shifts;
  const auto take = [&] {
    for (auto& [blocks, cost] : costs) {
      const auto shift = minimizer(cost);
      if (!shift) continue;
      const AngleShift& sum = cost.mean;
      shifts.push_back({.laser = laser,
                        .earlier = sum.earlier / cost.weight,
                        .later = sum.later / cost.weight,
                        .rate_earlier = sum.rate_earlier / cost.weight,
                        .rate_later = sum.rate_later / cost.weight,
                        .shift = *shift});
    }
    costs.clear();
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0 && block(lines[i].time) != block(lines[i - 1].time)) take();
    for (const std::size_t j : lines.earlier_passes(i)) {
      const double turns = kFullTurn * std::round((lines[j].angle - lines[i].angle) / kFullTurn);
      Cost& cost = costs[{block(lines[i].time), block(lines[j].time)}];
      cost.add(lines[i], lines[j]);
      compare(lines, i, lines.sweep_about(j, lines[i].time - lines.block()), turns, cost);
    }
  }
  take();
  return shifts;
}

}  // namespace

std::vector<AngleShift> angle_shifts(const Measurements& beams, const PlateTrajectory& plate) {
  if (beams.size() == 0 || plate.empty()) return {};
  const std::size_t lasers = *std::ranges::max_element(beams.laser) + std::size_t{1};
  std::vector<std::vector<AngleShift>> found(lasers);
  quality::for_each_index(lasers, [&](std::size_t laser) { found[laser] = shifts_of(beams, plate, laser); });
  std::vector<AngleShift> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace crisp::diagnose
