// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/emulate/emulated_device.hpp"
#include "grabbers/wire/cola_encoding.hpp"

namespace crisp {

/// One client's conversation with an emulated laser, without any network: telegrams in, answers out. Serves
/// the dialogues of the usual drivers, in CoLa-A and CoLa-B; what an LMS1xx does not know, or does not allow
/// without a login, is answered as it would.
class SickResponder {
 public:
  explicit SickResponder(EmulatedDevice& device) : device_(&device) {}

  /// The framed answer, in the language of the request.
  Bytes answer(const ColaTelegram& request);

  bool wants_scans() const { return wants_scans_; }
  /// Language of the scans: that of the last request, unless the client has chosen one.
  ColaLanguage language() const { return language_; }

 private:
  Bytes read(const ColaTelegram& request) const;
  Bytes write(const ColaTelegram& request);
  Bytes call(const ColaTelegram& request);
  Bytes set_output_range(const ColaTelegram& request);
  Bytes set_content(const ColaTelegram& request);
  Bytes set_scan(const ColaTelegram& request);
  Bytes subscribe(const ColaTelegram& request);

  EmulatedDevice* device_;
  ColaLanguage language_ = ColaLanguage::B;
  bool logged_in_ = false;
  bool wants_scans_ = false;
};

}  // namespace crisp
