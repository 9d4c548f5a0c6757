// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/model/range_variance.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {

/// A laser's range measurement of a true distance. The defaults are those of the LMS-151's data sheet.
struct RangeSettings {
  double sigma = 0.012;      ///< [m] standard deviation of the noise
  double quantum = 0.001;    ///< [m] ranges are multiples of it; 0: not rounded
  double max_distance = 50;  ///< [m] largest range with an echo
};

/// How one laser's noise departs from a plain normal one: effects `noise.*` of the catalogue. The defaults
/// change nothing.
struct NoiseEffects {
  double sigma = 0;           ///< [m] standard deviation; 0: of RangeSettings::sigma
  double slope = 0;           ///< asymptotic standard deviation per metre of range
  double spread = 0;          ///< [m] standard deviation at 45° that the incidence adds
  double jitter = 0;          ///< [m] standard deviation that an echo of remission 1 adds
  double tail_share = 0;      ///< share of the ranges whose noise is `tail_scale` times as large
  double tail_scale = 5;      ///< see tail_share
  double divergence = 0;      ///< [rad] by which the diameter of the spot grows a metre of range
  double aperture = 0;        ///< [m] diameter of the spot at the laser
  double merge = 1;           ///< [m] echoes of one spot no further apart than that become one
  double separation = 0;      ///< [m] between the two values about which ranges scatter
  double least_weight = 0.2;  ///< of the farther one: each beam's own is drawn between this …
  double most_weight = 0.9;   ///< … and this
  double step = 0;            ///< [m] ranges are multiples of it; 0: of RangeSettings::quantum
};

/// The errors of one laser's ranges at random.
class RangeNoise {
 public:
  /// @param laser  its name, for its random numbers
  /// @throws Error if a setting makes no sense
  RangeNoise(const RangeSettings& range, const NoiseEffects& effects, std::uint64_t seed,
             const std::string& laser);

  /// Random numbers of one beam, independent of the surface. To be drawn for every beam, in the order of
  /// firing.
  struct Draw {
    double normal = 0;  ///< of variance 1, or larger in the tail
    double shift = 0;   ///< [m]
  };
  Draw draw(std::uint16_t beam);

  /// The range [m] that is reported for an echo of `echo.range`.
  double reported(const model::EchoConditions& echo, const Draw& draw) const;

 private:
  double weight_of(std::uint16_t beam);

  model::ByPart sizes_;
  double quantum_;
  NoiseEffects effects_;
  statistics::RandomStream normal_;
  statistics::RandomStream tail_;
  statistics::RandomStream peak_;
  statistics::RandomStream weight_;
  std::vector<double> weights_;  ///< by beam as far as one was drawn, of the farther peak
};

}  // namespace crisp::simulate
