// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

namespace crisp::bag {

/// Inspector of bags, for `crisp info`.
Inspector bag_inspector();

}  // namespace crisp::bag
