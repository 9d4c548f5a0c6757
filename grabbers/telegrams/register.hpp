// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::telegrams {

/// grabber.telegrams.
void register_telegrams(Registrar& registrar);

}  // namespace crisp::telegrams
