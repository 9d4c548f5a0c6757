// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grabbers/wire/cola.hpp"

namespace crisp {

/// How far a conversation with a laser is.
enum class SickStep : std::uint8_t {
  DetectLanguage,  ///< a harmless question, in the hope that it is understood
  LogIn,
  StartMeasuring,
  Run,         ///< leaves the login
  AwaitReady,  ///< asked again and again until the laser measures
  Subscribe,
  Scans,    ///< they come by themselves
  Refused,  ///< the laser does not send scans
};

/// What is said to a laser until its scans come, without any network: requests out, telegrams in.
class SickDialogue {
 public:
  /// @param start  whether to log in and have it start measuring; otherwise nothing is changed
  SickDialogue(ColaLanguage language, bool start) : language_(language), start_(start) {}

  SickStep step() const { return step_; }
  ColaLanguage language() const { return language_; }

  /// The framed request of this step; none once scans come or were refused.
  Bytes request() const;

  /// What a telegram of the laser did to the dialogue.
  enum class Effect : std::uint8_t {
    None,      ///< no answer to the request: an event, or something not asked for
    Next,      ///< go on with the next request
    AskLater,  ///< the same again, in a while
  };
  Effect take(const ColaTelegram& telegram);

  /// What the laser refused, in words; each once.
  const std::vector<std::string>& refusals() const { return refusals_; }

 private:
  bool answers(const ColaTelegram& telegram) const;
  Effect advance();

  ColaLanguage language_;
  bool start_;
  SickStep step_ = SickStep::DetectLanguage;
  std::vector<std::string> refusals_;
};

/// The framed request that ends the scans.
Bytes unsubscribe_request(ColaLanguage language);

}  // namespace crisp
