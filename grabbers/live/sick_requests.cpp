// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/sick_requests.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "grabbers/wire/scan_data.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp::live {
namespace {

constexpr std::uint8_t kAuthorisedClient = 3;
constexpr std::uint32_t kItsPassword = 0xF4724744;  // as SICK's manual prints it
constexpr double kFrequencyUnits = 100;             // a Hertz

std::int32_t angle_units(double angle) {
  return static_cast<std::int32_t>(std::lround(angle / data::kDegree * wire::kUnitsPerDegree));
}

wire::OutputRange requested_range(const SickConfiguration& requested, const wire::ScanSettings& now) {
  return {.resolution = changed(now, requested).resolution,
          .first = angle_units(requested.output_range.at(0)),
          .last = angle_units(requested.output_range.at(1))};
}

/// Meaning of the status in an answer to mLMPsetscancfg.
std::string_view scan_settings_status(unsigned status) {
  static constexpr std::array<std::string_view, 5> kTexts{
      "done", "the frequency is not possible", "the resolution is not possible",
      "neither the frequency nor the resolution is possible", "the scan area is not possible"};
  return status < kTexts.size() ? kTexts.at(status) : "for another reason";
}

}  // namespace

wire::ScanSettings changed(wire::ScanSettings now, const SickConfiguration& requested) {
  if (requested.frequency) {
    now.frequency = static_cast<std::uint32_t>(std::lround(*requested.frequency * kFrequencyUnits));
  }
  if (requested.resolution) now.resolution = static_cast<std::uint32_t>(angle_units(*requested.resolution));
  return now;
}

SickRequest sick_request(SickStep step, const SickConfiguration& requested, const wire::ScanSettings& now) {
  switch (step) {
    case SickStep::LogIn:
      return {"sMN", "SetAccessMode", {kAuthorisedClient, kItsPassword}, "sAN"};
    case SickStep::ReadScanSettings:
      return {"sRN", "LMPscancfg", {}, "sRA"};
    case SickStep::SetScanSettings:
      return {"sMN", "mLMPsetscancfg", wire::to_values(changed(now, requested)), "sAN"};
    case SickStep::SetScanContent:
      return {"sWN", "LMDscandatacfg",
              wire::to_values(
                  wire::ScanContent{.remission = *requested.remission,
                                    .wide = true,
                                    .encoders = static_cast<std::uint16_t>(requested.encoder ? 1 : 0)}),
              "sWA"};
    case SickStep::SetOutputRange:
      return {"sWN", "LMPoutputRange", wire::to_values(requested_range(requested, now)), "sWA"};
    case SickStep::SetNtpOff:
      return {"sWN", "TSCRole", {std::uint8_t{0}}, "sWA"};
    case SickStep::StartMeasuring:
      return {"sMN", "LMCstartmeas", {}, "sAN"};
    case SickStep::Run:
      return {"sMN", "Run", {}, "sAN"};
    case SickStep::Subscribe:
      return {"sEN", wire::kScanDataName, {std::uint8_t{1}}, "sEA"};
    default:
      return {"sRN", "SCdevicestate", {}, "sRA"};
  }
}

bool is_granted(SickStep step, const wire::ColaTelegram& answer) {
  switch (step) {
    case SickStep::ReadScanSettings:
      return wire::scan_settings(answer, false).has_value();
    case SickStep::SetScanSettings:
    case SickStep::StartMeasuring:
      return wire::first_byte(answer) == 0U;
    case SickStep::LogIn:
    case SickStep::Run:
    case SickStep::AwaitReady:
    case SickStep::Subscribe:
      return wire::first_byte(answer) == 1U;
    default:
      return true;  // what is written is only acknowledged
  }
}

std::string refusal_text(SickStep step, const wire::ColaTelegram& answer) {
  if (const auto error = wire::cola_error_code(answer)) {
    return fmt::format("sFA {} ({})", *error, wire::cola_error_text(*error));
  }
  const unsigned value = wire::first_byte(answer).value_or(0);
  if (step != SickStep::SetScanSettings) return fmt::format("answered {}", value);
  return fmt::format("answered {} ({})", value, scan_settings_status(value));
}

}  // namespace crisp::live
