// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/sick_dialogue.hpp"

#include <fmt/format.h>

#include <utility>

#include "grabbers/wire/scan_data.hpp"

namespace crisp::live {

SickDialogue::SickDialogue(ColaLanguage language, bool start, SickConfiguration requested)
    : language_(language), start_(start || !requested.is_empty()), requested_(std::move(requested)) {}

wire::Bytes SickDialogue::request() const {
  if (step_ >= SickStep::Scans) return {};
  const SickRequest request = now();
  return wire::cola_message(request.command, request.name, request.parameters, language_);
}

SickDialogue::Effect SickDialogue::take(const wire::ColaTelegram& telegram) {
  if (step_ >= SickStep::Scans) return Effect::None;
  const SickRequest request = now();
  const bool error = telegram.command == "sFA";
  if (!error && (telegram.command != request.answer || telegram.name != request.name)) return Effect::None;
  if (step_ == SickStep::DetectLanguage) return advance();  // any answer shows that it understood
  if (!error && is_granted(step_, telegram)) {
    if (step_ == SickStep::ReadScanSettings) settings_ = *wire::scan_settings(telegram, false);
    return advance();
  }
  if (step_ == SickStep::AwaitReady && !error) return Effect::RequestLater;
  refusals_.push_back(fmt::format("{} {}: {}", request.command, request.name, refusal_text(step_, telegram)));
  if (step_ != SickStep::Subscribe) return advance();  // the laser may send scans all the same
  step_ = SickStep::Refused;
  return Effect::Next;
}

bool SickDialogue::needs(SickStep step) const {
  switch (step) {
    case SickStep::LogIn:
    case SickStep::StartMeasuring:
    case SickStep::Run:
      return start_;
    case SickStep::ReadScanSettings:
      return requested_.sets_mirror() || !requested_.output_range.empty();
    case SickStep::SetScanSettings:
      return requested_.sets_mirror() &&
             changed(settings_, requested_) != settings_;  // the motor would turn anew
    case SickStep::SetScanContent:
      return requested_.remission.has_value();
    case SickStep::SetOutputRange:
      return !requested_.output_range.empty();
    case SickStep::SetNtpOff:
      return requested_.ntp_off;
    default:
      return true;
  }
}

SickDialogue::Effect SickDialogue::advance() {
  do {
    step_ = static_cast<SickStep>(static_cast<int>(step_) + 1);
  } while (!needs(step_));
  return Effect::Next;
}

wire::Bytes unsubscribe_request(ColaLanguage language) {
  return wire::cola_message("sEN", wire::kScanDataName, {std::uint8_t{0}}, language);
}

}  // namespace crisp::live
