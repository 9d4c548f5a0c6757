// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/sick_dialogue.hpp"

#include <fmt/format.h>

#include <array>

#include "grabbers/wire/cola_message.hpp"
#include "grabbers/wire/scan_data.hpp"

namespace crisp {
namespace {

constexpr std::uint8_t kAuthorisedClient = 3;
constexpr std::uint32_t kItsPassword = 0xF4724744;  // as SICK's manual prints it

struct Request {
  std::string_view command, name;
  std::string_view answer;  ///< the command of what is answered
  std::vector<ColaValue> parameters;
};

const Request& request_of(SickStep step) {
  static const std::array<Request, 6> kRequests{{
      {"sRN", "SCdevicestate", "sRA", {}},
      {"sMN", "SetAccessMode", "sAN", {kAuthorisedClient, kItsPassword}},
      {"sMN", "LMCstartmeas", "sAN", {}},
      {"sMN", "Run", "sAN", {}},
      {"sRN", "SCdevicestate", "sRA", {}},
      {"sEN", kScanDataName, "sEA", {std::uint8_t{1}}},
  }};
  return kRequests.at(static_cast<std::size_t>(step));
}

/// Whether the first parameter of an answer says that what was asked for is so.
bool is_granted(SickStep step, unsigned value) {
  return step == SickStep::StartMeasuring ? value == 0 : value == 1;
}

}  // namespace

Bytes SickDialogue::request() const {
  if (step_ >= SickStep::Scans) return {};
  const Request& request = request_of(step_);
  return cola_message(request.command, request.name, request.parameters, language_);
}

bool SickDialogue::answers(const ColaTelegram& telegram) const {
  const Request& request = request_of(step_);
  return telegram.command == "sFA" || (telegram.command == request.answer && telegram.name == request.name);
}

SickDialogue::Effect SickDialogue::take(const ColaTelegram& telegram) {
  if (step_ >= SickStep::Scans || !answers(telegram)) return Effect::None;
  if (step_ == SickStep::DetectLanguage) return advance();  // whatever it says, it understood
  const auto error = cola_error_code(telegram);
  const auto value = first_byte(telegram);
  const bool granted = telegram.command != "sFA" && value && is_granted(step_, *value);
  if (granted) return advance();
  if (step_ == SickStep::AwaitReady && telegram.command != "sFA") return Effect::AskLater;
  const Request& request = request_of(step_);
  refusals_.push_back(fmt::format("{} {}: {}", request.command, request.name,
                                  error ? fmt::format("sFA {} ({})", *error, cola_error_text(*error))
                                        : fmt::format("answered {}", value.value_or(0))));
  if (step_ != SickStep::Subscribe) return advance();  // the laser may send scans all the same
  step_ = SickStep::Refused;
  return Effect::Next;
}

SickDialogue::Effect SickDialogue::advance() {
  const bool skip = step_ == SickStep::DetectLanguage && !start_;
  step_ = skip ? SickStep::AwaitReady : static_cast<SickStep>(static_cast<int>(step_) + 1);
  return Effect::Next;
}

Bytes unsubscribe_request(ColaLanguage language) {
  return cola_message("sEN", kScanDataName, {std::uint8_t{0}}, language);
}

}  // namespace crisp
