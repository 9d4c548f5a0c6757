// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/emulate/sick_responder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <map>

#include "grabbers/wire/binary_fields.hpp"
#include "grabbers/wire/text_fields.hpp"

namespace crisp::emulate {
namespace {

using wire::Bytes;
using wire::cola_error;
using wire::cola_message;
using wire::ColaTelegram;

using Values = std::vector<wire::ColaValue>;

constexpr std::uint16_t kMethodDenied = 1, kUnknownMethod = 2, kUnknownVariable = 3, kOutOfRange = 4,
                        kInvalidData = 5, kWriteDenied = 10, kUnknownCommand = 12, kUnknownEvent = 15;
constexpr unsigned kOtherFrequency = 1,
                   kOtherResolution = 2;  // what mLMPsetscancfg answers that it cannot do
constexpr std::uint8_t kMeasuring = 7, kIdle = 3;

std::uint8_t byte(unsigned value) { return static_cast<std::uint8_t>(value); }
std::uint16_t word(unsigned value) { return static_cast<std::uint16_t>(value); }

/// The evaluation of one field that is not configured: drivers refuse an answer without any.
Values field_evaluation(const EmulatedDevice& device) {
  constexpr std::uint32_t kOneAsFloat = 0x3F800000, kNone = 0;
  const wire::ScanSettings scans = device.settings();
  // One field: its version, number and counter; scale and offset of distances, and of angles; no result; no
  // time.
  return {word(1),     word(1), byte(1), kNone,   kOneAsFloat, kNone,  scans.resolution,
          scans.first, byte(0), word(0), word(0), word(0),     word(0)};
}

/// The variables that can be read, with their values. (In a generic lambda clang 14 takes a list of one
/// number for a size.)
const std::map<std::string_view, std::function<Values(const EmulatedDevice&)>, std::less<>>& variables() {
  static const std::map<std::string_view, std::function<Values(const EmulatedDevice&)>, std::less<>> kAll{
      {"DeviceIdent",
       [](const auto& device) {
         return Values{device.name, device.firmware};
       }},
      {"FirmwareVersion", [](const auto& device) { return Values{device.firmware}; }},
      {"LocationName", [](const auto&) { return Values{std::string("not defined")}; }},
      {"SCdevicestate", [](const auto& device) { return Values{byte(device.measuring ? 1 : 0)}; }},
      {"LCMstate", [](const auto&) { return Values{byte(0)}; }},
      {"STlms",
       [](const auto& device) {
         return Values{word(device.measuring ? kMeasuring : kIdle),
                       byte(0),
                       std::string("00:00:00"),
                       std::string("01.01.1970"),
                       word(0),
                       word(0),
                       word(0)};
       }},
      {"ODoprh", [](const EmulatedDevice&) { return Values{std::uint32_t{0}}; }},
      {"ODpwrc", [](const EmulatedDevice&) { return Values{std::uint32_t{1}}; }},
      {"LMPscancfg", [](const auto& device) { return wire::to_values(device.settings()); }},
      {"LMPoutputRange", [](const auto& device) { return wire::to_values(device.output_range()); }},
      {"LMDscandatacfg", [](const auto& device) { return wire::to_values(device.content()); }},
      {"SerialNumber",
       [](const auto& device) { return Values{fmt::format("{:08}", device.last.serial_number)}; }},
      {"LFErec", [](const auto& device) { return field_evaluation(device); }},
      {"LIDinputstate",  // version, system counter, four inputs, no time
       [](const auto&) {
         return Values{word(0), std::uint32_t{0}, byte(0), byte(0), byte(0), byte(0), word(0)};
       }},
  };
  return kAll;
}

/// "field000" to "field047": the evaluation fields of an LMS1xx, none of which is configured here.
bool is_field(std::string_view name) {
  constexpr std::string_view kField = "field";
  constexpr std::size_t kDigits = 3;
  constexpr unsigned kFields = 48;
  if (!name.starts_with(kField) || name.size() != kField.size() + kDigits) return false;
  unsigned number = kFields;
  const char* end = name.data() + name.size();
  return std::from_chars(name.data() + kField.size(), end, number).ptr == end && number < kFields;
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

/// Level and password of a SetAccessMode.
bool is_right_password(const ColaTelegram& request) {
  std::uint8_t level = 0;
  std::uint32_t password = 0;
  const auto read = [&](auto reader) {
    reader.number(level);
    reader.number(password);
    return reader.ok() && level == 3 && password == 0xF4724744;
  };
  return request.language == ColaLanguage::A ? read(wire::TextReader(wire::as_text(request.parameters)))
                                             : read(wire::BinaryReader(request.parameters));
}

}  // namespace

Bytes SickResponder::answer(const ColaTelegram& request) {
  language_ = request.language;
  if (request.command == "sRN") return read(request);
  if (request.command == "sWN") return write(request);
  if (request.command == "sMN") return call(request);
  if (request.command == "sEN") return subscribe(request);
  return cola_error(kUnknownCommand, request.language);
}

Bytes SickResponder::read(const ColaTelegram& request) const {
  if (request.name == wire::kScanDataName) {
    Bytes out;
    wire::append_scan_data(device_->sent(device_->last), request.language, "sRA", EncoderWidths::Position32,
                           out);
    return out;
  }
  if (is_field(request.name)) return cola_message("sRA", request.name, {byte(0)}, request.language);
  const auto known = variables().find(request.name);
  if (known == variables().end()) return cola_error(kUnknownVariable, request.language);
  return cola_message("sRA", request.name, known->second(*device_), request.language);
}

Bytes SickResponder::write(const ColaTelegram& request) {
  if (request.name == "EIHstCola") {
    language_ = wire::first_byte(request).value_or(1) == 1 ? ColaLanguage::B : ColaLanguage::A;
    return cola_message("sWA", request.name, {}, request.language);
  }
  const bool known = is_one_of(
      request.name, {"LMDscandatacfg", "LMPoutputRange", "LFPmeanfilter", "LFPparticle", "LFPnto1filter",
                     "FREchoFilter", "LICencset", "LICencres", "LICsrc", "TSCRole"});
  if (!known) return cola_error(kUnknownVariable, request.language);
  if (!logged_in_) return cola_error(kWriteDenied, request.language);
  if (request.name == "LMPoutputRange") return set_output_range(request);
  if (request.name == "LMDscandatacfg") return set_content(request);
  return cola_message("sWA", request.name, {}, request.language);
}

Bytes SickResponder::set_output_range(const ColaTelegram& request) {
  const auto range = wire::output_range(request);
  if (!range) return cola_error(kInvalidData, request.language);
  if (range->first > range->last) return cola_error(kOutOfRange, request.language);
  device_->range = range;
  return cola_message("sWA", request.name, {}, request.language);
}

Bytes SickResponder::set_content(const ColaTelegram& request) {
  const auto content = wire::scan_content(request);
  if (!content) return cola_error(kInvalidData, request.language);
  device_->configured = content;
  return cola_message("sWA", request.name, {}, request.language);
}

Bytes SickResponder::set_scan(const ColaTelegram& request) {
  const auto requested = wire::scan_settings(request, false);
  if (!requested) return cola_error(kInvalidData, request.language);
  const bool has_frequency = requested->frequency == device_->settings().frequency;
  const bool has_resolution = device_->set_resolution(requested->resolution);
  Values values{byte((has_frequency ? 0 : kOtherFrequency) + (has_resolution ? 0 : kOtherResolution))};
  for (auto& value : wire::to_values(device_->settings())) values.push_back(std::move(value));
  return cola_message("sAN", request.name, values, request.language);
}

Bytes SickResponder::call(const ColaTelegram& request) {
  const auto done = [&](unsigned value) {
    return cola_message("sAN", request.name, {byte(value)}, request.language);
  };
  if (request.name == "SetAccessMode") {
    logged_in_ = is_right_password(request);
    return done(logged_in_ ? 1 : 0);
  }
  const bool starts = request.name == "LMCstartmeas";
  const bool stops = is_one_of(request.name, {"LMCstopmeas", "LMCstandby"});
  const bool configures = request.name == "mLMPsetscancfg";
  const bool stores = is_one_of(request.name, {"mEEwriteall", "LSPsetdatetime"});
  if (request.name == "Run") {
    logged_in_ = false;
    return done(1);
  }
  if (!starts && !stops && !configures && !stores) return cola_error(kUnknownMethod, request.language);
  if (!logged_in_) return cola_error(kMethodDenied, request.language);
  if (stores) return done(1);
  if (configures) return set_scan(request);
  device_->measuring = starts;
  return done(0);
}

Bytes SickResponder::subscribe(const ColaTelegram& request) {
  if (!is_one_of(request.name, {wire::kScanDataName, "LFErec", "LIDoutputstate", "LIDinputstate"})) {
    return cola_error(kUnknownEvent, request.language);
  }
  const unsigned requested = wire::first_byte(request).value_or(0);
  if (request.name == wire::kScanDataName) wants_scans_ = requested == 1;
  return cola_message("sEA", request.name, {byte(requested)}, request.language);
}

}  // namespace crisp::emulate
