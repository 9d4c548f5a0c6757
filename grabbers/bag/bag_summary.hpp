// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grabbers/bag/bag_reader.hpp"

namespace crisp::bag {

/// Summary of one topic of a bag.
struct TopicSummary {
  std::string topic, type;
  std::uint64_t messages = 0;
  std::int64_t first_ns = 0, last_ns = 0;                        ///< receipts
  std::int64_t longest_gap_ns = 0;                               ///< between two receipts
  std::uint64_t stamped = 0;                                     ///< messages with a header's stamp
  double least_delay = std::numeric_limits<double>::infinity();  ///< [s] receipt less stamp
  double most_delay = -std::numeric_limits<double>::infinity();  ///< [s]
  std::set<std::string> joints;                                  ///< of joint states
  std::uint64_t unreadable = 0;                                  ///< messages that do not match their type

  double rate() const;  ///< [Hz] mean; 0: not known
};

/// Summary of a bag.
struct BagSummary {
  std::string format;
  std::vector<TopicSummary> topics;
  std::map<std::string, std::uint64_t> losses;
};

/// Reads a bag to its end.
BagSummary summarize(BagReader& reader);

/// Lines for people, without a line break at the end.
std::string to_text(const BagSummary& summary);
nlohmann::json to_json(const BagSummary& summary);

}  // namespace crisp::bag
