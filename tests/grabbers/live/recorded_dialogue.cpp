// SPDX-License-Identifier: BSD-3-Clause
#include "tests/grabbers/live/recorded_dialogue.hpp"

#include <boost/asio/write.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "grabbers/wire/scan_conversion.hpp"
#include "tests/grabbers/wire/samples.hpp"

namespace crisp::test {
namespace {

using namespace crisp::wire;

constexpr std::string_view kState = "SCdevicestate";

bool is_request(std::string_view command) {
  return command == "sRN" || command == "sWN" || command == "sMN" || command == "sEN";
}

}  // namespace

std::vector<RecordedTelegram> read_dialogue(const std::filesystem::path& file) {
  std::vector<RecordedTelegram> dialogue;
  std::ifstream text(file);
  for (const auto& entry : nlohmann::json::parse(text)) {
    const auto& tcp = entry.at("_source").at("layers").at("tcp");
    RecordedTelegram telegram;
    telegram.seconds = std::stod(tcp.at("Timestamps").at("tcp.time_relative").get<std::string>());
    telegram.bytes = from_hex(tcp.at("tcp.payload").get<std::string>());
    ColaFramer framer;
    framer.feed(telegram.bytes, 0, [&](const ColaFrame& frame) {
      if (const auto parsed = parse_cola(frame.payload, frame.language)) {
        telegram.command = parsed->command;
        telegram.name = parsed->name;
      }
    });
    telegram.to_device = is_request(telegram.command);
    dialogue.push_back(std::move(telegram));
  }
  return dialogue;
}

std::vector<Scan> scans_of(const std::vector<RecordedTelegram>& dialogue) {
  std::vector<Scan> scans;
  std::set<std::uint16_t> counters;
  for (const RecordedTelegram& recorded : dialogue) {
    if (recorded.command != "sSN" || recorded.name != kScanDataName) continue;
    for (const auto& found : find_telegrams(recorded.bytes)) {
      ScanData data;
      decode_scan_data(*parse_cola(found.payload, found.language), EncoderWidths::Position32, data);
      if (!counters.insert(data.telegram_counter).second) continue;
      to_scan(data, 0, std::llround(1e9 * recorded.seconds), scans.emplace_back());
    }
  }
  return scans;
}

RecordedDevice::RecordedDevice(const std::vector<RecordedTelegram>& dialogue, ColaLanguage language)
    : language_(language),
      responder_(device_),
      acceptor_(context_, {boost::asio::ip::make_address("127.0.0.1"), 0}),
      client_(context_),
      buffer_(4096) {
  std::string requested;
  for (const RecordedTelegram& telegram : dialogue) {
    const bool event =
        !telegram.to_device && (telegram.command == "sSN" || telegram.name == "LMDscandatamon");
    if (telegram.to_device) {
      requested = telegram.name;
    } else if (event) {
      events_.insert(events_.end(), telegram.bytes.begin(), telegram.bytes.end());
    } else if (telegram.command == "sFA") {
      refusal_ = telegram.bytes;
    } else if (telegram.name == requested) {
      answers_[requested] = telegram.bytes;
    }
  }
  answers_.erase(std::string(kState));  // was requested before the device measured, and not again
  accept();
  thread_ = std::thread([this] { context_.run(); });
}

RecordedDevice::~RecordedDevice() {
  context_.stop();
  thread_.join();
}

void RecordedDevice::accept() {
  acceptor_.async_accept(client_, [this](const boost::system::error_code& failure) {
    if (failure) return;
    framer_ = {};
    read();
  });
}

void RecordedDevice::read() {
  client_.async_read_some(boost::asio::buffer(buffer_), [this](const auto& failure, std::size_t bytes) {
    if (failure) {
      client_ = boost::asio::ip::tcp::socket(context_);
      return accept();
    }
    framer_.feed(ByteView(buffer_).first(bytes), 0, [this](const ColaFrame& frame) {
      const auto request = parse_cola(frame.payload, frame.language);
      if (request && frame.language == language_) answer(*request);  // in another one it is not understood
    });
    read();
  });
}

void RecordedDevice::answer(const ColaTelegram& request) {
  const auto recorded = answers_.find(std::string(request.name));
  const bool refused = recorded == answers_.end() && !refusal_.empty() && request.name != kState;
  Bytes printed = recorded != answers_.end() ? recorded->second
                  : refused                  ? refusal_
                                             : responder_.answer(request);
  const bool subscribes =
      request.command == "sEN" && request.name == kScanDataName && first_byte(request) == 1U;
  if (subscribes) printed.insert(printed.end(), events_.begin(), events_.end());
  boost::system::error_code ignored;
  boost::asio::write(client_, boost::asio::buffer(printed), ignored);
}

}  // namespace crisp::test
