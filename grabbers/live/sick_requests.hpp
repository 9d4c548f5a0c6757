// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "grabbers/live/configuration_mismatch.hpp"
#include "grabbers/wire/scan_settings.hpp"

namespace crisp::live {

/// Steps of the dialogue with a laser.
enum class SickStep : std::uint8_t {
  DetectLanguage,    ///< a harmless question, in the hope that it is understood
  LogIn,             ///< as the authorised client
  ReadScanSettings,  ///< what is not to be changed stays as it is
  SetScanSettings,
  SetScanContent,
  SetOutputRange,
  SetNtpOff,
  StartMeasuring,
  Run,         ///< leaves the login and puts settings in force
  AwaitReady,  ///< polled until the laser measures
  Subscribe,
  Scans,    ///< they come by themselves
  Refused,  ///< the laser does not send scans
};

/// The request of one step, and its answer.
struct SickRequest {
  std::string_view command, name;
  std::vector<wire::ColaValue> parameters;
  std::string_view answer;  ///< the command of what is answered
};

/// @param now  the laser's current settings, as it reported them
SickRequest sick_request(SickStep step, const SickConfiguration& requested, const wire::ScanSettings& now);

/// The settings that `now` are in force with what is wanted in their place.
wire::ScanSettings changed(wire::ScanSettings now, const SickConfiguration& requested);

/// Whether an answer (that is no sFA) confirms the request.
bool is_granted(SickStep step, const wire::ColaTelegram& answer);

/// Why it is not so, in words: "answered 2 (the resolution is not possible)".
std::string refusal_text(SickStep step, const wire::ColaTelegram& answer);

}  // namespace crisp::live
