// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/decode.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace independent {
namespace {

std::uint64_t number_at(const std::string& bytes, std::size_t at, int size, bool is_little = false) {
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) {
    const int place = is_little ? size - 1 - i : i;
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(place)));
  }
  return value;
}

struct Datagram {
  double time;
  std::string data;
};

std::size_t link_header_size(std::uint64_t type, const std::string& frame) {
  if (type == 1) return number_at(frame, 12, 2) == 0x8100 ? 18 : 14;
  if (type == 113) return 16;
  if (type == 276) return 20;
  return type == 0 ? 4 : 0;
}

std::vector<Datagram> read_packets(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string all((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const bool is_ng = number_at(all, 0, 4) == 0x0A0D0D0A, is_little = is_ng || all[0] != '\xa1';
  const bool has_nanoseconds = is_ng || number_at(all, 0, 4, is_little) == 0xA1B23C4D;
  const auto at = [&](std::size_t place, int size = 4) { return number_at(all, place, size, is_little); };
  std::vector<Datagram> packets;
  std::uint64_t type = is_ng ? 0 : at(20), first = 0;
  const auto keep = [&](std::uint64_t nanoseconds, std::size_t begin, std::size_t size) {
    if (packets.empty()) first = nanoseconds;
    const std::string frame = all.substr(begin, size);
    packets.push_back(
        {1e-9 * static_cast<double>(nanoseconds - first), frame.substr(link_header_size(type, frame))});
  };
  for (std::size_t i = is_ng ? 0 : 24; i < all.size();) {
    if (!is_ng) {
      keep(at(i) * 1000000000 + at(i + 4) * (has_nanoseconds ? 1 : 1000), i + 16, at(i + 8));
      i += 16 + at(i + 8);
      continue;
    }
    if (at(i) == 1) type = at(i + 8, 2);
    if (at(i) == 6) keep(at(i + 12) << 32 | at(i + 16), i + 28, at(i + 20));
    i += at(i + 4);
  }
  return packets;
}

/// Reads a telegram's fields, as tokens (CoLa-A) or packed (CoLa-B).
class FieldReader {
 public:
  FieldReader(std::string body, bool is_text) : body_(std::move(body)), is_text_(is_text) {}

  std::uint32_t number(int bytes) {
    if (is_text_) return static_cast<std::uint32_t>(std::stoul(token(), nullptr, 16));
    at_ += static_cast<std::size_t>(bytes);
    return static_cast<std::uint32_t>(number_at(body_, at_ - static_cast<std::size_t>(bytes), bytes));
  }
  void skip(std::initializer_list<int> sizes) {
    for (const int size : sizes) number(size);
  }
  std::string name() {
    if (is_text_) return token();
    at_ += 5;
    return body_.substr(at_ - 5, 5);
  }

 private:
  std::string token() {
    const auto end = std::min(body_.find(' ', at_), body_.size());
    std::string found = body_.substr(at_, end - at_);
    at_ = end + 1;
    return found;
  }

  std::string body_;
  bool is_text_;
  std::size_t at_ = 0;
};

DecodedScan decode_scan(const std::string& body, bool is_text, double receipt) {
  FieldReader in(body, is_text);
  DecodedScan scan{.receipt = receipt, .ranges = {}};
  in.skip({2, 2, 4, 1, 1, 2});
  scan.scan_counter = static_cast<std::uint16_t>(in.number(2));
  scan.stamp_us = in.number(4);
  scan.transmission_us = in.number(4);
  in.skip({1, 1, 1, 1, 2, 4, 4, 2, 2});
  if (in.name() != "DIST1") throw std::runtime_error("a telegram has no DIST1");
  in.skip({4, 4, 4, 2});
  for (auto values = in.number(2); values > 0; --values) scan.ranges.push_back(1e-3 * in.number(2));
  return scan;
}

/// The bytes of one TCP stream in order, and for each place the time by which all before it had arrived.
struct Stream {
  std::string bytes;
  std::vector<std::pair<std::size_t, double>> ends;

  double complete(std::size_t end) const {
    return std::lower_bound(ends.begin(), ends.end(), std::pair(end, -1.0))->second;
  }
};

Stream reassemble(const std::vector<std::pair<std::uint32_t, Datagram>>& segments) {
  std::map<std::int32_t, Datagram> ordered;  // the first arrival counts
  for (const auto& [sequence, segment] : segments) {
    ordered.emplace(static_cast<std::int32_t>(sequence - segments.front().first), segment);
  }
  Stream stream;
  double time = 0;
  for (const auto& [place, segment] : ordered) {
    time = std::max(time, segment.time);
    stream.bytes += segment.data;
    stream.ends.emplace_back(stream.bytes.size(), time);
  }
  return stream;
}

std::vector<DecodedScan> decode_stream(const Stream& stream) {
  const std::string &bytes = stream.bytes, event = "sSN LMDscandata ";
  std::vector<DecodedScan> scans;
  for (std::size_t i = 0; i < bytes.size();) {
    const bool is_binary = bytes.compare(i, 4, "\x02\x02\x02\x02") == 0;
    const std::size_t begin = i + (is_binary ? 8 : 1);
    const std::size_t end = is_binary ? begin + number_at(bytes, i + 4, 4) : bytes.find('\x03', begin);
    if (end >= bytes.size()) break;
    if (bytes.compare(begin, event.size(), event) == 0) {
      const std::size_t fields = begin + event.size();
      scans.push_back(decode_scan(bytes.substr(fields, end - fields), !is_binary, stream.complete(end + 1)));
    }
    i = end + 1;
  }
  return scans;
}

void decode_sentences(const Datagram& datagram, std::vector<DecodedReading>& readings) {
  std::istringstream lines(datagram.data);
  for (std::string line; std::getline(lines, line);) {
    unsigned sequence, device_us, count;
    if (std::sscanf(line.c_str(), "$PPLT,%u,%u,%u*", &sequence, &device_us, &count) != 3) continue;
    readings.push_back({datagram.time, device_us, count});
  }
}

}  // namespace

DecodedCapture decode_capture(const std::string& path) {
  DecodedCapture capture;
  std::map<std::string, std::vector<std::pair<std::uint32_t, Datagram>>> segments;
  for (const auto& packet : read_packets(path)) {
    const auto& ip = packet.data;
    if (number_at(ip, 9, 1) == 17) {
      decode_sentences({packet.time, ip.substr(28)}, capture.readings);
      continue;
    }
    std::string from;
    for (std::size_t i = 12; i < 16; ++i) from += (i > 12 ? "." : "") + std::to_string(number_at(ip, i, 1));
    from += ":" + std::to_string(number_at(ip, 20, 2));
    if (ip.size() > 40)
      segments[from].emplace_back(static_cast<std::uint32_t>(number_at(ip, 24, 4)),
                                  Datagram{packet.time, ip.substr(40)});
  }
  for (const auto& [from, parts] : segments) capture.scans[from] = decode_stream(reassemble(parts));
  return capture;
}

}  // namespace independent
