// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <crisp/scan.hpp>

#include "grabbers/emulate/sick_responder.hpp"
#include "grabbers/wire/cola_framer.hpp"

namespace crisp::test {

/// One telegram of a recorded dialogue.
struct RecordedTelegram {
  double seconds = 0;
  bool to_device = false;
  std::string command, name;
  wire::Bytes bytes;  ///< with its framing
};

/// The telegrams of a dialogue that was converted to JSON, as data/sick/README.md describes it.
std::vector<RecordedTelegram> read_dialogue(const std::filesystem::path& file);

/// The scans in it, those that TCP sent again but once.
std::vector<Scan> scans_of(const std::vector<RecordedTelegram>& dialogue);

/// A server that answers with what a real device answered: to each request what was recorded for its name,
/// and to others the real refusal, or where none was recorded what an emulated laser answers. To who
/// subscribes to scans it sends all that the device sent by itself, byte for byte.
class RecordedDevice {
 public:
  RecordedDevice(const std::vector<RecordedTelegram>& dialogue, ColaLanguage language);
  ~RecordedDevice();
  RecordedDevice(const RecordedDevice&) = delete;
  RecordedDevice& operator=(const RecordedDevice&) = delete;

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept();
  void read();
  void answer(const wire::ColaTelegram& request);

  ColaLanguage language_;
  std::map<std::string, wire::Bytes> answers_;  ///< by the request's name
  wire::Bytes refusal_;                         ///< empty where none was recorded
  wire::Bytes events_;
  emulate::EmulatedDevice device_;
  emulate::SickResponder responder_;

  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::ip::tcp::socket client_;
  wire::Bytes buffer_;
  wire::ColaFramer framer_;
  std::thread thread_;
};

}  // namespace crisp::test
