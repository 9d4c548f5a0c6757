// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::velodyne {

/// grabber.velodyne.
void register_velodyne(Registrar& registrar);

}  // namespace crisp::velodyne
