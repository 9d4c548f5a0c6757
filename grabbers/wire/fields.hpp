// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace crisp::wire {

/// Why a telegram's fields could not be read.
enum class FieldFailure : std::uint8_t {
  None,
  TooShort,    ///< a field, or what a count promises, does not fit in the payload
  NotANumber,  ///< CoLa-A: a token is empty or holds other characters than digits
  OutOfRange,  ///< CoLa-A: a number is too large for its field
  BadFlag,     ///< a flag is neither 0 nor 1
  BadText,     ///< CoLa-A: a text's length does not lead to a separator
  TooMany,     ///< more blocks than any device has
};

/// The failure in words.
constexpr std::string_view to_string(FieldFailure failure) {
  switch (failure) {
    case FieldFailure::None:
      return "none";
    case FieldFailure::TooShort:
      return "the payload is too short for its fields";
    case FieldFailure::NotANumber:
      return "a token is not a number";
    case FieldFailure::OutOfRange:
      return "a number is too large for its field";
    case FieldFailure::BadFlag:
      return "a flag is neither 0 nor 1";
    case FieldFailure::BadText:
      return "a text does not end at its stated length";
    case FieldFailure::TooMany:
      return "more blocks than any device sends";
  }
  return "unknown";
}

/// Common base of both languages' readers. The first failure sticks, and later reads change nothing: a reader
/// of fields may read on and test once at the end.
class FieldReader {
 public:
  bool ok() const { return failure_ == FieldFailure::None; }
  FieldFailure failure() const { return failure_; }
  void fail(FieldFailure failure) {
    if (ok()) failure_ = failure;
  }

 private:
  FieldFailure failure_ = FieldFailure::None;
};

}  // namespace crisp::wire
