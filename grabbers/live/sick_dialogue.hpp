// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "grabbers/live/sick_requests.hpp"

namespace crisp::live {

/// The dialogue with a laser until its scans come, without any network: requests out, telegrams in.
class SickDialogue {
 public:
  /// @param start   whether to log in and have it start measuring; otherwise nothing is changed
  /// @param wanted  how it is to measure; if anything is wanted, it is logged in and started all the same
  SickDialogue(ColaLanguage language, bool start, SickConfiguration requested = {});

  SickStep step() const { return step_; }
  ColaLanguage language() const { return language_; }

  /// The framed request of this step; none once scans come or were refused.
  wire::Bytes request() const;
  /// Whether the answer to it may take a minute: the motor turns anew.
  bool is_slow() const { return step_ == SickStep::SetScanSettings; }

  /// Effect of a laser's telegram on the dialogue.
  enum class Effect : std::uint8_t {
    None,          ///< no answer to the request: an event, or an unrequested telegram
    Next,          ///< go on with the next request
    RequestLater,  ///< the same again, in a while
  };
  Effect take(const wire::ColaTelegram& telegram);

  /// The laser's refusals, in words; each once.
  const std::vector<std::string>& refusals() const { return refusals_; }

 private:
  SickRequest now() const { return sick_request(step_, requested_, settings_); }
  bool needs(SickStep step) const;
  Effect advance();

  ColaLanguage language_;
  bool start_;
  SickConfiguration requested_;
  wire::ScanSettings settings_;  ///< of the laser
  SickStep step_ = SickStep::DetectLanguage;
  std::vector<std::string> refusals_;
};

/// The framed request that ends the scans.
wire::Bytes unsubscribe_request(ColaLanguage language);

}  // namespace crisp::live
