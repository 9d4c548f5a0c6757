// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/cola_encoding.hpp"

#include "grabbers/wire/binary_fields.hpp"
#include "grabbers/wire/text_fields.hpp"

namespace crisp::wire {
namespace {

void append(const ColaValue& value, TextWriter writer) {
  if (const auto* text = std::get_if<std::string>(&value)) {
    writer.number(static_cast<std::uint16_t>(text->size()));
    writer.text(*text, text->size());
    return;
  }
  std::visit(
      [&](const auto& number) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(number)>, std::string>) writer.number(number);
      },
      value);
}

void append(const ColaValue& value, BinaryWriter writer) {
  std::visit(
      [&](const auto& number) {
        if constexpr (std::is_same_v<std::decay_t<decltype(number)>, std::string>) {
          writer.number(static_cast<std::uint16_t>(number.size()));
          writer.text(number, number.size());
        } else {
          writer.number(number);
        }
      },
      value);
}

}  // namespace

Bytes cola_message(std::string_view command, std::string_view name, const std::vector<ColaValue>& parameters,
                   ColaLanguage language) {
  Bytes payload(command.begin(), command.end());
  payload.push_back(' ');
  payload.insert(payload.end(), name.begin(), name.end());
  const bool acknowledges = command == "sWA";  // devices end a bare acknowledgement with a space
  if (language == ColaLanguage::B && (!parameters.empty() || acknowledges)) payload.push_back(' ');
  for (const ColaValue& value : parameters) {
    if (language == ColaLanguage::A) {
      append(value, TextWriter(payload));
    } else {
      append(value, BinaryWriter(payload));
    }
  }
  return cola_frame(payload, language);
}

Bytes cola_error(std::uint16_t code, ColaLanguage language) {
  Bytes payload{'s', 'F', 'A'};  // in CoLa-B its code follows without a space
  if (language == ColaLanguage::A) {
    TextWriter(payload).number(code);
  } else {
    BinaryWriter(payload).number(code);
  }
  return cola_frame(payload, language);
}

std::optional<unsigned> first_byte(const ColaTelegram& telegram) {
  std::uint8_t value = 0;
  const auto read = [&](auto reader) {
    reader.number(value);
    return reader.ok();
  };
  const bool good = telegram.language == ColaLanguage::A ? read(TextReader(as_text(telegram.parameters)))
                                                         : read(BinaryReader(telegram.parameters));
  if (!good) return {};
  return value;
}

}  // namespace crisp::wire
