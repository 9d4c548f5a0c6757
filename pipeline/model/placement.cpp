// SPDX-License-Identifier: BSD-3-Clause
// How measurements go through their lasers' chains: equation (2) alone by vectors, every other chain in
// blocks.
#include <cmath>
#include <limits>

#include <crisp/sensor_model.hpp>

#include "pipeline/model/mixed_batch.hpp"
#include "pipeline/model/traced_runs.hpp"

namespace crisp {
namespace {

/// Gathers placed points and hands them on, many at a time, of measurements that follow one another.
class Gathering {
 public:
  explicit Gathering(const TakePlaced& take) : take_(take) {}

  void add(std::size_t measurement, const Vector3<double>& point) {
    go_on_at(measurement);
    x_[size_] = point.x();
    y_[size_] = point.y();
    z_[size_] = point.z();
    if (++size_ == kCapacity) hand_on();
  }

  /// Places the beams of a mixed batch, and empties it.
  void add(model::MixedBeams& mixed) {
    hand_on();
    mixed.place();
    for (std::size_t k = 0; k < mixed.size();) {
      const std::size_t end = mixed.consecutive_end(k);
      take_({.first = mixed.index(k), .x = mixed.x(k, end), .y = mixed.y(k, end), .z = mixed.z(k, end)});
      k = end;
    }
    mixed.clear();
  }

  /// Places a run of one laser that starts at `begin` by equation (2) alone. Returns the end of the run.
  std::size_t add_bare(const Measurements& beams, std::size_t begin, const simd::BareLaser& laser,
                       const PlateTrajectory& plate, MirrorAngleCache& known) {
    const std::size_t end = model::run_end(beams, begin, kCapacity - size_);
    const auto mirrors = known.of(beams.laser[begin], beams.beam[end - 1] + std::size_t{1});
    for (std::size_t i = begin; i < end;) {
      const auto arc = plate.arc(beams.time[i] + laser.eta);
      if (!arc) {
        ++i;
        continue;
      }
      go_on_at(i);
      const simd::BareBeams rest{&beams.range[i], &beams.mirror_angle[i], &beams.time[i], &beams.beam[i],
                                 end - i};
      const std::size_t placed =
          simd::place_bare(rest, laser, *arc, mirrors, &x_[size_], &y_[size_], &z_[size_]);
      size_ += placed;
      i += placed;
    }
    if (size_ == kCapacity) hand_on();
    return end;
  }

  void hand_on() {
    if (size_ > 0) take_({.first = first_, .x = {x_, size_}, .y = {y_, size_}, .z = {z_, size_}});
    size_ = 0;
  }

 private:
  /// Sets the measurement of the next beams.
  void go_on_at(std::size_t measurement) {
    if (measurement != first_ + size_) hand_on();
    if (size_ == 0) first_ = measurement;
  }

  static constexpr std::size_t kCapacity = 1024;

  const TakePlaced& take_;
  double x_[kCapacity + simd::kBeyond];
  double y_[kCapacity + simd::kBeyond];
  double z_[kCapacity + simd::kBeyond];
  std::size_t first_ = 0;  ///< measurement
  std::size_t size_ = 0;
};

/// Whether beams are so near to one another in time that a vector of them mostly lies between two readings.
bool are_dense(const Measurements& beams, std::size_t begin, std::size_t end, const PlateTrajectory& plate) {
  if (plate.size() < 2) return false;
  const auto many = static_cast<double>(end - begin) / simd::kBeyond;
  const double interval = (plate.end() - plate.begin()) / static_cast<double>(plate.size());
  return many >= 1 && many * interval >= std::abs(beams.time[end - 1] - beams.time[begin]);
}

/// Up to where all beams from `begin` on, at most to `limit`, are of lasers whose chains are bare.
std::size_t bare_end(const std::vector<LaserChain>& chains, const Measurements& beams, std::size_t begin,
                     std::size_t limit) {
  std::size_t end = begin;
  while (end < std::min(limit, beams.size()) && model::chain_of(chains, beams, end).bare) ++end;
  return end;
}

}  // namespace

simd::MirrorTable MirrorAngleCache::of(std::size_t laser, std::size_t beams) {
  if (tables_.size() <= laser) tables_.resize(laser + 1);
  Table& own = tables_[laser];
  if (own.angle.size() < beams) {
    own.angle.resize(beams, std::numeric_limits<float>::quiet_NaN());  // equal to no angle
    own.sine.resize(beams);
    own.cosine.resize(beams);
  }
  return {own.angle.data(), own.sine.data(), own.cosine.data(), own.angle.size()};
}

void SensorModel::place(const Measurements& beams, const PlateTrajectory& plate,
                        const TakePlaced& take) const {
  MirrorAngleCache known;
  place(beams, plate, take, known);
}

void SensorModel::place(const Measurements& beams, const PlateTrajectory& plate, const TakePlaced& take,
                        MirrorAngleCache& known) const {
  model::check_epochs(beams, plate);
  std::vector<std::vector<double>> parameters(fixed_->chains.size());
  for (std::size_t k = 0; k < fixed_->chains.size(); ++k) {
    if (!fixed_->chains[k].bare) parameters[k] = model::chain_values(fixed_->chains[k], values_);
  }
  model::Tracer<double> tracer(beams, plate);
  Gathering points(take);
  model::MixedBeams mixed(*bare_, plate);
  for (std::size_t i = 0; i < beams.size();) {
    const LaserChain& chain = model::chain_of(fixed_->chains, beams, i);
    const std::size_t laser = beams.laser[i];
    if (chain.bare) {
      std::size_t end = model::run_end(beams, i, model::MixedBeams::kCapacity);
      if (are_dense(beams, i, end, plate)) {
        points.add(mixed);
        i = points.add_bare(beams, i, (*bare_)[laser], plate, known);
        continue;
      }
      // Where a run is shorter than a vector, those after it mostly are, too.
      if (end - i < simd::kBeyond)
        end = bare_end(fixed_->chains, beams, end, i + model::MixedBeams::kCapacity);
      while (i < end) {
        if (mixed.room() == 0) points.add(mixed);
        const std::size_t last = std::min(end, i + mixed.room());
        mixed.add(beams, i, last);
        i = last;
      }
    } else {
      points.add(mixed);
      i = tracer.trace_run(chain, parameters[laser], i,
                           [&](std::size_t k, const Beam<double>& beam) { points.add(k, beam.point()); });
    }
  }
  points.add(mixed);
  points.hand_on();
}

Placed SensorModel::place(const Measurements& beams, const PlateTrajectory& plate) const {
  Placed result;
  result.points.resize(3, static_cast<Eigen::Index>(beams.size()));
  result.index.reserve(beams.size());
  place(beams, plate, [&](const PlacedRun& run) {
    for (std::size_t i = 0; i < run.x.size(); ++i) {
      result.points.col(static_cast<Eigen::Index>(result.index.size())) << run.x[i], run.y[i], run.z[i];
      result.index.push_back(static_cast<std::uint32_t>(run.first + i));
    }
  });
  result.points.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(result.index.size()));
  return result;
}

}  // namespace crisp
