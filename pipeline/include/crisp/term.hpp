// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace crisp {

/// A number with its derivatives with respect to up to eight parameters.
using Jet = ceres::Jet<double, 8>;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

/// One beam on its way through the chain of the sensor model. T is double or Jet; measurements of the device
/// and the encoder are plain double, quantities of the model are T. Each phase of the chain may read all that
/// earlier phases have set:
///
/// | phase  | sets                | frame                                                            |
/// |--------|---------------------|------------------------------------------------------------------|
/// | time   | time                | the plate's clock                                                |
/// | plate  | plate_angle         | the encoder reading is kept in encoder_angle                     |
/// | mirror | mirror_angle        |                                                                  |
/// | beam   | origin, direction   | the laser's: the scan plane is z = 0, θ = 0 along +x             |
/// | mount  | origin, direction   | the plate's, before the turn by φ + λ: x outwards, z = spin axis |
/// | base   | origin, direction   | the base's: z = spin axis                                        |
/// | range  | range               |                                                                  |
///
/// The point is origin + range * direction. A term that corrects a reading computes the correction from the
/// reading itself (hub_time, encoder_angle, measured_mirror, measured_range), not from what other terms have
/// made of it, so that their order does not matter.
template <class T>
struct Beam {
  double measured_range = 0;   ///< [m]
  double measured_mirror = 0;  ///< [rad] θ
  double hub_time = 0;         ///< [s since the run's epoch]
  double remission = 0;        ///< device's units
  double cos_incidence = 1;    ///< cos β on the surface that was met; 1 where nobody knows it
  std::uint16_t number = 0;    ///< index in its scan

  T time{};                                   ///< [s since the run's epoch] hub_time + η
  T encoder_angle{};                          ///< [rad] φ at `time` as the encoder reads it
  T plate_rate{};                             ///< [rad/s] its derivative
  T plate_direction{};                        ///< PlateState::direction at `time`
  T plate_angle{};                            ///< [rad] φ at `time`
  T mirror_angle{};                           ///< [rad] θ
  Vector3<T> origin = Vector3<T>::Zero();     ///< [m]
  Vector3<T> direction = Vector3<T>::Zero();  ///< unit vector
  T range{};                                  ///< [m]

  /// The measured point [m], in the frame that origin and direction are in.
  Vector3<T> point() const { return origin + direction * range; }
};

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
    kOfSimpleForm,  ///< the value of the same parameter of the cause's simple form, which the model must
                    ///< have
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

/// The phase of the chain in which a term acts: see the table at Beam.
enum class Phase { kTime, kPlate, kMirror, kBeam, kMount, kBase, kRange };
inline constexpr std::size_t kPhases = static_cast<std::size_t>(Phase::kRange) + 1;

/// Origin of a term's covariate. Recordings with different origins do not share its parameters.
enum class CountsFrom { kNothing, kRunsEpoch, kEncodersZero };

/// Declaration of a term: all that is known of it but its formula.
struct TermInfo {
  std::string name;                               ///< as in docs/effects.md: "mirror.cone"
  std::string summary;                            ///< in half a sentence
  Phase phase = Phase::kRange;                    ///< in which it changes a beam
  Scope scope = Scope::kLaser;                    ///< the laser's or the plate's
  std::vector<EffectParameter> parameters;        ///< in the order in which `change` gets them
  std::string details;                            ///< see EffectInfo
  std::string resolvable_by = {};                 ///< see EffectInfo
  CountsFrom counts_from = CountsFrom::kNothing;  ///< of its covariate
  bool needs_incidence = false;  ///< it does nothing where nobody has found how beams met their surfaces
  /// For an empirical term, which describes a departure by its shape: the covariate of the shape ("mirror
  /// angle"). Empty for the others.
  std::string covariate = {};
  /// For a term that is another member of a cause's family: the cause, which a departure of this term is
  /// reported as. See family_of().
  std::string family = {};
  /// The cause that is a constant of the same quantity, where this one's zero is a convention: then such a
  /// constant belongs to it.
  std::string level = {};
  bool is_fine =
      false;  ///< for an empirical term: it has many parameters, and is fitted only to the others' residual
  /// Whether its parameters belong to the base model, since their standard deviations are known from
  /// elsewhere: it is no candidate cause.
  bool is_nuisance = false;
};

/// The cause whose family the term belongs to: all forms that the same physics can take, with the same
/// invariances. Empty for an empirical term whose invariances are those of no cause.
inline const std::string& family_of(const TermInfo& info) {
  return info.family.empty() && info.covariate.empty() ? info.name : info.family;
}

/// One departure of a real scanner from equation (2): parameters, and how they change a beam. Immutable.
/// Derive from DifferentiableTerm, not from this.
class ModelTerm {
 public:
  virtual ~ModelTerm() = default;
  /// The declaration; the same at each call.
  virtual const TermInfo& info() const = 0;

  /// Changes each beam; `parameters` are in the order of info().parameters.
  virtual void apply(std::span<Beam<double>> beams, std::span<const double> parameters) const = 0;
  /// The same with derivatives.
  virtual void apply(std::span<Beam<Jet>> beams, std::span<const Jet> parameters) const = 0;
};

/// Writes both `apply` for a term whose formula is a template, so that it is written once and differentiated
/// automatically:
///
///     struct Cone : DifferentiableTerm<Cone> {
///       const TermInfo& info() const override;
///       template <class T> void change(Beam<T>& beam, std::span<const T> parameters) const;
///     };
template <class Term>
class DifferentiableTerm : public ModelTerm {
 public:
  [[gnu::flatten]] void apply(std::span<Beam<double>> beams, std::span<const double> parameters) const final {
    for (auto& beam : beams) static_cast<const Term&>(*this).change(beam, parameters);
  }
  [[gnu::flatten]] void apply(std::span<Beam<Jet>> beams, std::span<const Jet> parameters) const final {
    for (auto& beam : beams) static_cast<const Term&>(*this).change(beam, parameters);
  }
};

/// The terms that are known by name: the built-in ones and those of plugins.
class TermRegistry {
 public:
  /// @throws Error if the name is taken, or the term's declaration is invalid
  void add(std::shared_ptr<const ModelTerm> term);
  /// @throws Error naming the nearest known term
  std::shared_ptr<const ModelTerm> get(const std::string& name) const;
  /// Whether a term of this name was added.
  bool knows(const std::string& name) const;
  /// All known names, in alphabetical order.
  std::vector<std::string> names() const;

 private:
  std::vector<std::shared_ptr<const ModelTerm>> terms_;
};

}  // namespace crisp
