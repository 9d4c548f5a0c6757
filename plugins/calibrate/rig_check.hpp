// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/rig.hpp>

#include "pipeline/estimate/parameter_prior.hpp"

namespace crisp::calibrate {

/// The calibration of the mirror image of the scene, which the same measurements fit as well if the encoder's
/// counts are negated: by equation (2) λ → −λ + const, τ → −τ, α → −α for each laser. The first laser whose λ
/// was not estimated keeps it, as it defines the frame. Without terms beyond equation (2).
Calibration mirrored(const Calibration& calibration);

/// The same calibration as (λ, τ, α) or as (λ, −τ, α + 180°) of all lasers at once, which is the frame turned
/// by 180°: in the form that is nearer to the rig's nominal values.
Calibration match_form_of_rig(Calibration calibration, const Rig& rig);

/// Result of comparing a calibration with a rig's nominal values.
struct RigCheck {
  bool is_mirrored = false;   ///< the mirror image agrees with the rig, clearly better than the calibration
  bool is_explained = false;  ///< what contradicts the rig is one of its usual mistakes
  bool knows_direction = false;      ///< the mirror image is clearly farther from the rig
  std::vector<std::string> caveats;  ///< what contradicts the rig, and what to do; empty if nothing does
};

/// Compares a calibration with the rig's nominal values. Neither RQE nor surfels can do it: a mirrored scene
/// has the same RQE, and so has one whose lasers have exchanged their names.
///
/// A contradiction is explained, where that fits clearly better and all lasers, by one of: counts that grow
/// the other way; two exchanged lasers; a laser mounted upside down; azimuths of the other sign. Where
/// several fit equally well, as counts and upside-down lasers do for two lasers that face each other, the
/// caveat has all of them. Otherwise each τ and α outside its range, and each λ far from its nominal value,
/// is reported by itself.
///
/// @param calibration  one laser for each of the rig's, in its order
/// @param range        [m, rad] how far τ and α may be from their nominal values
RigCheck check_with_rig(const Calibration& calibration, const Rig& rig,
                        const estimate::ParameterPrior& range);

/// The calibration's mirror image, in the form near the rig, if the rig leaves the encoder's direction to the
/// calibration and the mirror image agrees with the rig. Otherwise nothing.
std::optional<Calibration> in_direction_of_rig(const Calibration& calibration, const Rig& rig,
                                               const RigCheck& check);

/// The entry of a calibration's provenance that states what determines the plate's direction: kFromRecording,
/// or kFromRig where the mirror image agrees with the nominal values as well.
inline constexpr const char* kDirectionSource = "direction_from";
inline constexpr const char* kFromRecording = "recording";
inline constexpr const char* kFromRig = "rig";

/// Sets that entry of a calibration that check_with_rig() has compared; removes it where the rig is
/// contradicted, or nothing determines the direction.
void note_direction(Calibration& calibration, const Rig& rig, const RigCheck& check);

/// The message of in_direction_of_rig().
inline constexpr const char* kCountsClockwise =
    "the encoder counts clockwise, by the signs of tau and alpha and the order of the lasers; the calibration takes it so. Set plate.direction: clockwise in the rig";

/// The caveat of a calibration that leaves it open, which more accurate values may resolve.
extern const std::string_view kDirectionIsOpen;

/// Whether the rig leaves the direction to the calibration, and its mirror image agrees with the nominal
/// values as well.
bool leaves_direction_open(const Rig& rig, const RigCheck& check);

/// The parameters whose standard error is about that which the rig gives them.
std::vector<std::string> known_from_rig_only(const Calibration& calibration,
                                             const estimate::ParameterPrior& prior);

/// The caveats of check_with_rig() for a refined calibration, without those that its start has had: a τ, an α
/// or a λ that the rig gives without a standard deviation may be as far from its nominal value as the
/// start's.
std::vector<std::string> new_contradictions(const Calibration& calibration, const Calibration& start,
                                            const Rig& rig);

}  // namespace crisp::calibrate
