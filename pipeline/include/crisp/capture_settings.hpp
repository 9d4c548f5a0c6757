// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <crisp/scan.hpp>

namespace crisp {

/// Settings for parsing a capture.
struct CaptureSettings {
  EncoderWidths encoder_widths = EncoderWidths::Position32;  ///< of encoders that are wired to lasers
  double max_wait = 5;                     ///< [s] of capture time that a lost TCP segment is waited for
  std::function<bool()> interrupted = {};  ///< polled while a capture is read from a pipe: whether to give up
};

}  // namespace crisp
