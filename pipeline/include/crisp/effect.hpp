// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace crisp {

/// Owner of an effect: each laser with parameters of its own, the plate, each device (lasers and plate: with
/// a clock and a link), or the scene.
enum class Scope { kLaser, kPlate, kDevice, kScene };

/// Between which values a search for the form of a departure steps, and how.
struct Tries {
  /// How the tried values are spaced.
  enum class Spacing {
    kLinear,        ///< evenly
    kLogarithmic,   ///< evenly in the logarithm
    kRangePeriods,  ///< evenly in 1/x, none longer than the farthest range: less than one period is
                    ///< unresolvable
    kInstants,      ///< evenly over the recording, `from` and `to` being shares of it
  };
  Spacing spacing = Spacing::kLinear;  ///< of the tried values
  double from = 0;                     ///< the first value, in the parameter's unit
  double to = 1;                       ///< the last value, in the parameter's unit
  int count = 0;                       ///< number of tried values
};

/// One parameter of an effect.
struct EffectParameter {
  std::string name;     ///< "kappa": of a-z, 0-9 and _
  std::string unit;     ///< of the value: "m", "rad", "s", "1", "m s^2" …
  double lower = 0;     ///< bounds for calibration
  double upper = 0;     ///< see `lower`
  double neutral = 0;   ///< with all parameters at theirs, the effect changes nothing
  std::string summary;  ///< in half a sentence
  /// It is a shape parameter, no amplitude: while the amplitudes are neutral it has no effect, so that a
  /// search has to step through it.
  bool shape = false;
  Tries tries = {};  ///< for a form; count 0: it is left at its neutral value
  /// An amplitude of an effect with a form: whether what it does is the same in every form.
  bool is_the_same_in_every_form = false;
};

/// One departure of a real scanner from equation (2), its clocks, its noise or its scene from the plain ones.
struct EffectInfo {
  std::string name;                         ///< as in docs/effects.md: "mirror.cone"
  std::string summary;                      ///< in half a sentence
  Scope scope = Scope::kLaser;              ///< what has parameters of its own
  std::vector<EffectParameter> parameters;  ///< in the order in which a calibration lists them
  std::string details;                      ///< its formula, typical sizes and their source, in Markdown
  std::string resolvable_by = {};           ///< what a recording needs to distinguish it from similar effects
};

}  // namespace crisp
