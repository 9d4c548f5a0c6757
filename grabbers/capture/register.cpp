// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/register.hpp"

#include "grabbers/capture/capture_inspector.hpp"
#include "grabbers/capture/capture_stage.hpp"

namespace crisp::capture {

void register_capture(Registrar& registrar) {
  registrar.stage<CaptureStage>();
  registrar.inspector(capture_inspector());
}

}  // namespace crisp::capture
