// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/term.hpp>

namespace crisp::model {

// The built-in terms, by what of the scanner they are of.
void register_mount_terms(TermRegistry& terms);
void register_mirror_terms(TermRegistry& terms);
void register_encoder_terms(TermRegistry& terms);
void register_plate_terms(TermRegistry& terms);
void register_base_terms(TermRegistry& terms);
void register_timing_terms(TermRegistry& terms);
void register_range_terms(TermRegistry& terms);
void register_range_in_time_terms(TermRegistry& terms);

// Departures described by their shape, where no cause is identified.
void register_empirical_terms(TermRegistry& terms);

}  // namespace crisp::model
