// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/emulate/emulated_device.hpp"
#include "grabbers/wire/cola_encoding.hpp"

namespace crisp::emulate {

/// One client's conversation with an emulated laser, without any network: telegrams in, answers out. Serves
/// the dialogues of the usual drivers, in CoLa-A and CoLa-B; what an LMS1xx does not know, or does not allow
/// without a login, is answered as it would.
class SickResponder {
 public:
  explicit SickResponder(EmulatedDevice& device) : device_(&device) {}

  /// The framed answer, in the language of the request.
  wire::Bytes answer(const wire::ColaTelegram& request);

  bool wants_scans() const { return wants_scans_; }
  /// Language of the scans: that of the last request, unless the client has chosen one.
  ColaLanguage language() const { return language_; }

 private:
  wire::Bytes read(const wire::ColaTelegram& request) const;
  wire::Bytes write(const wire::ColaTelegram& request);
  wire::Bytes call(const wire::ColaTelegram& request);
  wire::Bytes set_output_range(const wire::ColaTelegram& request);
  wire::Bytes set_content(const wire::ColaTelegram& request);
  wire::Bytes set_scan(const wire::ColaTelegram& request);
  wire::Bytes subscribe(const wire::ColaTelegram& request);

  EmulatedDevice* device_;
  ColaLanguage language_ = ColaLanguage::B;
  bool logged_in_ = false;
  bool wants_scans_ = false;
};

}  // namespace crisp::emulate
