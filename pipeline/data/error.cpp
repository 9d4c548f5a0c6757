// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <crisp/error.hpp>

namespace crisp {
namespace {

std::string full_text(const std::string& what, const std::string& advice, const Place& place) {
  // The catcher of an error without a place prefixes "error: " to what().
  std::string text = to_string(place);
  text += (text.empty() ? "" : ": error: ") + what;
  if (!advice.empty()) text += "; " + advice;
  return text;
}

std::string joined(const std::vector<Error>& errors) {
  std::string text;
  for (const auto& error : errors) text += (text.empty() ? "" : "\n") + std::string(error.what());
  return text;
}

}  // namespace

std::string to_string(const Place& place) {
  if (place.line == 0) return place.file;
  return fmt::format("{}:{}:{}", place.file, place.line, place.column);
}

Error::Error(std::string what, std::string advice, Place place)
    : std::runtime_error(full_text(what, advice, place)),
      message_(std::move(what)),
      advice_(std::move(advice)),
      place_(std::move(place)) {}

Error Error::of_option(std::string name) const {
  Error error = *this;
  error.option_ = std::move(name);
  return error;
}

Errors::Errors(std::vector<Error> errors)
    : Error(errors.size() == 1 ? errors.front() : Error(joined(errors))), errors_(std::move(errors)) {}

}  // namespace crisp
