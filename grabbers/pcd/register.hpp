// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::pcd_grabber {

void register_pcd(Registrar& registrar);

}  // namespace crisp::pcd_grabber
