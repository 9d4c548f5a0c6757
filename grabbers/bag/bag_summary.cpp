// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "grabbers/bag/byte_cursor.hpp"
#include "grabbers/bag/ros_message_schema.hpp"

namespace crisp::bag {
namespace {

constexpr double kSecondsPerNs = 1e-9;

/// Gathers statistics of a topic's messages.
class TopicWatch {
 public:
  explicit TopicWatch(const BagConnection& connection)
      : encoding_(connection.encoding), layout_(parse_ros_layout(connection.type, connection.definition)) {
    summary_.topic = connection.topic;
    summary_.type = connection.type;
    if (!layout_ || encoding_ == RosEncoding::other) return;
    if (const RosField* stamp = layout_->stamp()) {
      sec_ = stamp->parts.at(0);
      nanosec_ = stamp->parts.at(1);
    }
    if (connection.type == "sensor_msgs/JointState") joints_ = layout_->find("name");
  }

  void add(const BagMessage& message) {
    if (summary_.messages++ == 0)
      summary_.first_ns = message.receipt_ns;
    else
      summary_.longest_gap_ns = std::max(summary_.longest_gap_ns, message.receipt_ns - summary_.last_ns);
    summary_.last_ns = message.receipt_ns;
    if (!sec_ || !nanosec_) return;
    try {
      add_header(message);
    } catch (const BagDamage&) {
      ++summary_.unreadable;
    }
  }

  const TopicSummary& summary() const { return summary_; }

 private:
  void add_header(const BagMessage& message) {
    constexpr double kNanosecond = 1e-9;
    double stamp = 0, delay = 0;
    constexpr std::int64_t kSecond = 1'000'000'000;
    const std::int64_t whole = message.receipt_ns / kSecond;
    const auto receipt = static_cast<double>(whole);
    for (const RosValue& value : decode_ros(*layout_, encoding_, message.data)) {
      const RosType type = layout_->fields[value.field].type;
      if (value.field == sec_) stamp = value.number(type);
      if (value.field == nanosec_)
        delay = kNanosecond * (static_cast<double>(message.receipt_ns % kSecond) - value.number(type));
      if (value.field == joints_) summary_.joints.emplace(value.bytes);
    }
    delay += receipt - stamp;
    ++summary_.stamped;
    summary_.least_delay = std::min(summary_.least_delay, delay);
    summary_.most_delay = std::max(summary_.most_delay, delay);
  }

  RosEncoding encoding_;
  std::optional<RosMessageSchema> layout_;
  std::optional<std::size_t> sec_, nanosec_, joints_;
  TopicSummary summary_;
};

std::string line_of(const TopicSummary& topic) {
  std::string line =
      fmt::format("\n  {:<28} {:<32} {:>8} {:>8.2f} Hz {:>9.3f} s", topic.topic, topic.type, topic.messages,
                  topic.rate(), kSecondsPerNs * static_cast<double>(topic.longest_gap_ns));
  if (topic.stamped > 0) {
    line += fmt::format("  {:.1f} to {:.1f} ms", 1e3 * topic.least_delay, 1e3 * topic.most_delay);
  }
  if (!topic.joints.empty()) line += fmt::format("\n    joints: {}", fmt::join(topic.joints, ", "));
  if (topic.unreadable > 0)
    line += fmt::format("\n    {} messages that do not match their type", topic.unreadable);
  return line;
}

}  // namespace

double TopicSummary::rate() const {
  const double length = kSecondsPerNs * static_cast<double>(last_ns - first_ns);
  return length > 0 ? static_cast<double>(messages - 1) / length : 0;
}

BagSummary summarize(BagReader& reader) {
  std::vector<TopicWatch> watches;
  std::map<std::pair<std::string, std::string>, std::size_t> of_topic;  // several may publish on one
  std::vector<std::size_t> of_connection;
  const auto watch_all = [&] {
    while (of_connection.size() < reader.connections().size()) {
      const BagConnection& connection = reader.connections()[of_connection.size()];
      const auto [known, is_new] = of_topic.try_emplace({connection.topic, connection.type}, watches.size());
      if (is_new) watches.emplace_back(connection);
      of_connection.push_back(known->second);
    }
  };
  while (const auto message = reader.next()) {
    watch_all();
    watches[of_connection[message->connection]].add(*message);
  }
  watch_all();
  BagSummary summary{.format = reader.format(), .losses = reader.losses()};
  for (const auto& watch : watches) summary.topics.push_back(watch.summary());
  return summary;
}

std::string to_text(const BagSummary& summary) {
  std::string text = fmt::format("  {}\n  {:<28} {:<32} {:>8} {:>11} {:>11}  {}", summary.format, "topic",
                                 "type", "messages", "rate", "longest gap", "receipt less stamp");
  for (const auto& topic : summary.topics) text += line_of(topic);
  for (const auto& [what, n] : summary.losses) text += fmt::format("\n  {} {}", n, what);
  return text;
}

nlohmann::json to_json(const BagSummary& summary) {
  auto topics = nlohmann::json::array();
  for (const auto& topic : summary.topics) {
    topics.push_back({{"topic", topic.topic},
                      {"type", topic.type},
                      {"messages", topic.messages},
                      {"first_ns", topic.first_ns},
                      {"last_ns", topic.last_ns},
                      {"rate", topic.rate()},
                      {"longest_gap", kSecondsPerNs * static_cast<double>(topic.longest_gap_ns)},
                      {"unreadable", topic.unreadable}});
    if (topic.stamped > 0) topics.back()["receipt_less_stamp"] = {topic.least_delay, topic.most_delay};
    if (!topic.joints.empty()) topics.back()["joints"] = topic.joints;
  }
  return {{"format", summary.format}, {"topics", topics}, {"losses", summary.losses}};
}

}  // namespace crisp::bag
