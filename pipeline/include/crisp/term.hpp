// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <crisp/beam.hpp>
#include <crisp/effect.hpp>

namespace crisp {

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
  /// The zero of its quantity is a convention, so that a constant of the same kind belongs to it.
  bool has_free_level = false;
  bool is_fine =
      false;  ///< for an empirical term: it has many parameters, and is fitted only to the others' residual
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
