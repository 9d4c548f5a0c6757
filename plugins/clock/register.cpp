// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/register.hpp"

#include "plugins/clock/clock_stages.hpp"

namespace crisp::clock {

void register_clock(Registrar& registrar) {
  registrar.stage<ConvexHullStage>();
  registrar.stage<OnlineStage>();
  registrar.stage<ReceiptStage>();
}

}  // namespace crisp::clock
