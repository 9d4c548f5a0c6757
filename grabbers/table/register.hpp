// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::table {

/// grabber.table and grabber.encoder_lines.
void register_table(Registrar& registrar);

}  // namespace crisp::table
