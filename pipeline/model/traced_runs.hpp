// SPDX-License-Identifier: BSD-3-Clause
// What placing measurements, with and without derivatives, has in common.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <crisp/error.hpp>
#include <crisp/sensor_model.hpp>

#include "pipeline/data/internal_error.hpp"
#include "pipeline/model/chain.hpp"
#include "pipeline/model/simd_placement.hpp"

namespace crisp::model {

inline constexpr std::size_t kTracedBlock =
    64;  // beams that go through a chain of terms together: they fit the cache

inline void check_epochs(const Measurements& beams, const PlateTrajectory& plate) {
  if (beams.size() > 0 && !plate.empty() && beams.epoch_ns != plate.epoch_ns()) {
    throw data::internal_error(
        "the measurements and the plate's trajectory count their time from different epochs");
  }
}

/// @throws Error if beam i is of none of the calibration's lasers
inline void check_laser(std::size_t lasers, const Measurements& beams, std::size_t i) {
  if (beams.laser[i] < lasers) return;
  throw Error("the measurements contain laser " + std::to_string(beams.laser[i] + 1) +
                  ", but the calibration has only " + std::to_string(lasers),
              "use the calibration of the recorded rig");
}

/// The chain of the laser that measured beam i.
inline const LaserChain& chain_of(const std::vector<LaserChain>& chains, const Measurements& beams,
                                  std::size_t i) {
  check_laser(chains.size(), beams, i);
  return chains[beams.laser[i]];
}

/// End of the run of measurements of one laser that starts at `begin`, at most `most` long.
inline std::size_t run_end(const Measurements& beams, std::size_t begin, std::size_t most) {
  constexpr std::size_t kStep = 32;  // compared without a branch
  const std::uint16_t laser = beams.laser[begin];
  const std::size_t limit = std::min(beams.size(), begin + most);
  std::size_t end = begin + 1;
  for (std::uint16_t others = 0; end + kStep <= limit; end += kStep) {
    for (std::size_t k = 0; k < kStep; ++k) {
      others = static_cast<std::uint16_t>(others | (beams.laser[end + k] ^ laser));  // no wider: by vectors
    }
    if (others != 0) break;
  }
  while (end < limit && beams.laser[end] == laser) ++end;
  return end;
}

inline std::vector<double> chain_values(const LaserChain& chain, const Eigen::VectorXd& values) {
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
    block[i].cos_incidence = beams.cos_incidence.empty() ? 1 : beams.cos_incidence[begin + i];
  }
}

/// Passes beams through chains with any terms.
template <class T>
class Tracer {
 public:
  Tracer(const Measurements& beams, const PlateTrajectory& plate) : beams_(beams), plate_(plate) {}

  /// Traces a run of one laser that starts at `begin`, at most a block, and visits those beams that the plate
  /// covers: visit(index of the measurement, beam). Returns the end of the run.
  template <class Visit>
  std::size_t trace_run(const LaserChain& chain, std::span<const T> parameters, std::size_t begin,
                        Visit visit) {
    const std::size_t end = run_end(beams_, begin, kTracedBlock);
    block_.resize(kTracedBlock);  // at the first run: where all chains are bare, there is none
    const std::span<Beam<T>> run(block_.data(), end - begin);
    fill(beams_, begin, run);
    trace<T>(chain, parameters, run, plate_, known_);
    for (std::size_t i = 0; i < run.size(); ++i) {
      if (known_[i]) visit(begin + i, run[i]);
    }
    return end;
  }

 private:
  const Measurements& beams_;
  const PlateTrajectory& plate_;
  std::vector<Beam<T>> block_;
  std::array<bool, kTracedBlock> known_{};
};

inline simd::BareLaser bare_laser(std::span<const double> parameters) {
  return {.lambda = parameters[0],
          .tau = parameters[1],
          .cos_alpha = std::cos(parameters[2]),
          .sin_alpha = std::sin(parameters[2]),
          .eta = parameters[3]};
}

inline std::vector<simd::BareLaser> bare_lasers(const std::vector<LaserChain>& chains,
                                                const Eigen::VectorXd& values) {
  std::vector<simd::BareLaser> result;
  for (const auto& chain : chains) result.push_back(bare_laser(chain_values(chain, values)));
  return result;
}

}  // namespace crisp::model
