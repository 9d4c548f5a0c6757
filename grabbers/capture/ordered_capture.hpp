// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grabbers/capture/capture_file.hpp"
#include "grabbers/capture/packet_order.hpp"

namespace crisp::capture {

/// The packets of a capture file as CaptureFile gives them, in the order in which they arrived: its stretches
/// are merged by time, as survey_capture() finds them. A pipe is read as it is.
class OrderedCapture {
 public:
  /// @param interrupted  as ByteStream's
  /// @throws Error as CaptureFile
  explicit OrderedCapture(const std::filesystem::path& path, std::function<bool()> interrupted = {});

  /// The next packet, valid until the next call; nullptr at the end of the file.
  const Packet* next();
  /// [ns] What is to be added to the time of this packet.
  std::int64_t shift_of(const devices::IpPacket& packet) const;

  const std::vector<std::string>& remarks() const { return order_.remarks; }
  Counts losses() const;
  Counts notes() const;
  std::uint64_t offset() const;                 ///< [bytes] read so far
  std::uint64_t size() const { return size_; }  ///< [bytes] of the file; 0 for a pipe

 private:
  struct Part {
    std::unique_ptr<CaptureFile> file;
    std::uint64_t begin = 0;  // [bytes]
    std::int64_t shift_ns = 0;
    Packet packet = {};  // the next
    bool is_over = false;
  };

  void open_what_is_due();
  static void load(Part& part);
  void close_what_is_over();

  std::filesystem::path path_;
  std::function<bool()> interrupted_;
  std::uint64_t size_ = 0;
  PacketOrder order_;
  std::size_t opened_ = 0;            // of the order's stretches
  std::vector<Part> parts_;           // that are open
  std::optional<std::size_t> given_;  // the part whose packet was given last
  Counts losses_, notes_;             // of those that are over
  std::uint64_t read_ = 0;            // [bytes] of those that are over
};

}  // namespace crisp::capture
