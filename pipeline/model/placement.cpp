// SPDX-License-Identifier: BSD-3-Clause
// How measurements go through their lasers' chains: equation (2) alone by vectors, every other chain in
// blocks.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "pipeline/data/error.hpp"
#include "pipeline/model/bare_chain.hpp"
#include "pipeline/model/chain.hpp"
#include "pipeline/model/sensor_model.hpp"

namespace crisp {
namespace {

constexpr std::size_t kBlock = 64;  // beams that go through a chain of terms together: they fit the cache

void check_epochs(const Measurements& beams, const PlateTrajectory& plate) {
  if (beams.size() > 0 && !plate.empty() && beams.epoch_ns != plate.epoch_ns()) {
    throw Error("the measurements and the plate's trajectory count their time from different epochs");
  }
}

/// The chain of the laser that measured beam i.
const LaserChain& chain_of(const std::vector<LaserChain>& chains, const Measurements& beams, std::size_t i) {
  if (beams.laser[i] < chains.size()) return chains[beams.laser[i]];
  throw Error("the measurements name laser " + std::to_string(beams.laser[i] + 1) +
                  ", but the calibration has only " + std::to_string(chains.size()),
              "use the calibration of the rig that was recorded");
}

/// End of the run of measurements of one laser that starts at `begin`, at most `most` long.
std::size_t run_end(const Measurements& beams, std::size_t begin, std::size_t most) {
  constexpr std::size_t kStep = 16;  // compared without a branch
  const unsigned laser = beams.laser[begin];
  const std::size_t limit = std::min(beams.size(), begin + most);
  std::size_t end = begin + 1;
  for (unsigned others = 0; end + kStep <= limit; end += kStep) {
    for (std::size_t k = 0; k < kStep; ++k) others |= beams.laser[end + k] ^ laser;
    if (others != 0) break;
  }
  while (end < limit && beams.laser[end] == laser) ++end;
  return end;
}

std::vector<double> chain_values(const LaserChain& chain, const Eigen::VectorXd& values) {
  std::vector<double> result;
  for (const auto slot : chain.slots) result.push_back(values[static_cast<Eigen::Index>(slot)]);
  return result;
}

template <class T>
void fill(const Measurements& beams, std::size_t begin, std::span<Beam<T>> block) {
  for (std::size_t i = 0; i < block.size(); ++i) {
    block[i].measured_range = beams.range[begin + i];
    block[i].measured_mirror = beams.mirror_angle[begin + i];
    block[i].hub_time = beams.time[begin + i];
    block[i].remission = beams.remission[begin + i];
    block[i].number = beams.beam[begin + i];
  }
}

/// Takes beams through chains with whatever terms they have.
template <class T>
class Tracer {
 public:
  Tracer(const Measurements& beams, const PlateTrajectory& plate) : beams_(beams), cursor_(plate) {}

  /// Traces a run of one laser that starts at `begin`, at most a block, and visits those beams that the plate
  /// covers: visit(index of the measurement, beam). Returns the end of the run.
  template <class Visit>
  std::size_t trace_run(const LaserChain& chain, std::span<const T> parameters, std::size_t begin,
                        Visit visit) {
    const std::size_t end = run_end(beams_, begin, kBlock);
    block_.resize(kBlock);  // at the first run: where all chains are bare, there is none
    const std::span<Beam<T>> run(block_.data(), end - begin);
    fill(beams_, begin, run);
    trace<T>(chain, parameters, run, cursor_, known_);
    for (std::size_t i = 0; i < run.size(); ++i) {
      if (known_[i]) visit(begin + i, run[i]);
    }
    return end;
  }

  PlateTrajectory::Cursor& cursor() { return cursor_; }

 private:
  const Measurements& beams_;
  PlateTrajectory::Cursor cursor_;
  std::vector<Beam<T>> block_;
  std::array<bool, kBlock> known_{};
};

/// Gathers placed points and hands them on, many at a time.
class Gathering {
 public:
  explicit Gathering(const TakePlaced& take) : take_(take) {}

  void add(std::size_t measurement, const Vector3<double>& point) {
    x_[size_] = point.x();
    y_[size_] = point.y();
    z_[size_] = point.z();
    index_[size_] = static_cast<std::uint32_t>(measurement);
    if (++size_ == kCapacity) hand_on();
  }

  /// Places a run of one laser that starts at `begin` by equation (2) alone. Returns the end of the run.
  std::size_t add_bare(const Measurements& beams, std::size_t begin, const simd::BareLaser& laser,
                       PlateTrajectory::Cursor& cursor) {
    const std::size_t end = run_end(beams, begin, kCapacity - size_);
    for (std::size_t i = begin; i < end;) {
      const auto arc = cursor.arc(beams.time[i] + laser.eta);
      if (!arc) {
        ++i;
        continue;
      }
      const simd::BareBeams rest{&beams.range[i], &beams.mirror_angle[i], &beams.time[i], end - i};
      const std::size_t placed = simd::place_bare(rest, laser, *arc, &x_[size_], &y_[size_], &z_[size_]);
      std::iota(&index_[size_], &index_[size_] + placed, static_cast<std::uint32_t>(i));
      size_ += placed;
      i += placed;
    }
    if (size_ == kCapacity) hand_on();
    return end;
  }

  void hand_on() {
    take_({.x = {x_, size_}, .y = {y_, size_}, .z = {z_, size_}, .index = {index_, size_}});
    size_ = 0;
  }

 private:
  static constexpr std::size_t kCapacity = 1024;

  const TakePlaced& take_;
  double x_[kCapacity + simd::kBeyond];
  double y_[kCapacity + simd::kBeyond];
  double z_[kCapacity + simd::kBeyond];
  std::uint32_t index_[kCapacity];
  std::size_t size_ = 0;
};

simd::BareLaser bare_laser(std::span<const double> parameters) {
  return {.lambda = parameters[0],
          .tau = parameters[1],
          .cos_alpha = std::cos(parameters[2]),
          .sin_alpha = std::sin(parameters[2]),
          .eta = parameters[3]};
}

/// For each laser, the free parameters that it depends on and the slot of each in its chain.
struct FreeSlots {
  std::vector<std::vector<std::size_t>> columns;  ///< index into the list of free parameters
  std::vector<std::vector<std::size_t>> slots;    ///< index into the laser's slots
};

FreeSlots free_slots(const std::vector<LaserChain>& chains, const std::vector<std::size_t>& free) {
  FreeSlots result;
  for (const auto& chain : chains) {
    auto& columns = result.columns.emplace_back();
    auto& slots = result.slots.emplace_back();
    for (std::size_t f = 0; f < free.size(); ++f) {
      const auto slot = std::find(chain.slots.begin(), chain.slots.end(), free[f]);
      if (slot == chain.slots.end()) continue;
      columns.push_back(f);
      slots.push_back(static_cast<std::size_t>(slot - chain.slots.begin()));
    }
  }
  return result;
}

/// The parameters of each laser; the free ones from column `first` on are seeded in a Jet's derivatives.
std::vector<std::vector<Jet>> seeded_parameters(const std::vector<LaserChain>& chains,
                                                const Eigen::VectorXd& values, const FreeSlots& free,
                                                std::size_t first) {
  std::vector<std::vector<Jet>> all;
  for (std::size_t laser = 0; laser < chains.size(); ++laser) {
    const auto plain = chain_values(chains[laser], values);
    auto& seeded = all.emplace_back(plain.begin(), plain.end());
    const auto& own = free.slots[laser];
    const std::size_t last = std::min(first + static_cast<std::size_t>(Jet::DIMENSION), own.size());
    for (std::size_t k = first; k < last; ++k) seeded[own[k]].v[static_cast<Eigen::Index>(k - first)] = 1;
  }
  return all;
}

}  // namespace

void SensorModel::place(const Measurements& beams, const PlateTrajectory& plate,
                        const TakePlaced& take) const {
  check_epochs(beams, plate);
  std::vector<std::vector<double>> parameters;
  std::vector<simd::BareLaser> bare;
  for (const auto& chain : chains_) {
    parameters.push_back(chain_values(chain, values_));
    bare.push_back(bare_laser(parameters.back()));
  }
  Tracer<double> tracer(beams, plate);
  Gathering points(take);
  for (std::size_t i = 0; i < beams.size();) {
    const LaserChain& chain = chain_of(chains_, beams, i);
    const std::size_t laser = beams.laser[i];
    if (chain.bare) {
      i = points.add_bare(beams, i, bare[laser], tracer.cursor());
    } else {
      i = tracer.trace_run(chain, parameters[laser], i,
                           [&](std::size_t k, const Beam<double>& beam) { points.add(k, beam.point()); });
    }
  }
  points.hand_on();
}

Placed SensorModel::place(const Measurements& beams, const PlateTrajectory& plate) const {
  Placed result;
  result.points.resize(3, static_cast<Eigen::Index>(beams.size()));
  result.index.reserve(beams.size());
  place(beams, plate, [&](const PlacedRun& run) {
    auto column = static_cast<Eigen::Index>(result.index.size());
    for (std::size_t i = 0; i < run.index.size(); ++i) {
      result.points.col(column++) << run.x[i], run.y[i], run.z[i];
    }
    result.index.insert(result.index.end(), run.index.begin(), run.index.end());
  });
  result.points.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(result.index.size()));
  return result;
}

Placed SensorModel::place(const Measurements& beams, const PlateTrajectory& plate,
                          const std::vector<std::size_t>& free, PointDerivatives& derivatives) const {
  Placed result = place(beams, plate);
  const FreeSlots slots = free_slots(chains_, free);
  derivatives.columns = slots.columns;
  derivatives.stride = 0;
  for (const auto& columns : slots.columns) derivatives.stride = std::max(derivatives.stride, columns.size());
  derivatives.values.setZero(3, static_cast<Eigen::Index>(result.index.size() * derivatives.stride));

  // As many passes as it takes to seed every free parameter in one of a Jet's derivatives.
  constexpr std::size_t kWidth = Jet::DIMENSION;
  for (std::size_t first = 0; first < derivatives.stride; first += kWidth) {
    const auto seeded = seeded_parameters(chains_, values_, slots, first);
    const auto count = static_cast<Eigen::Index>(std::min(kWidth, derivatives.stride - first));
    auto column = static_cast<Eigen::Index>(first);
    Tracer<Jet> tracer(beams, plate);
    for (std::size_t i = 0; i < beams.size();) {
      const std::size_t laser = beams.laser[i];
      i = tracer.trace_run(chains_[laser], seeded[laser], i, [&](std::size_t, const Beam<Jet>& beam) {
        const Vector3<Jet> x = beam.point();
        for (int axis = 0; axis < 3; ++axis) {
          derivatives.values.row(axis).segment(column, count) = x[axis].v.head(count).transpose();
        }
        column += static_cast<Eigen::Index>(derivatives.stride);
      });
    }
  }
  return result;
}

}  // namespace crisp
