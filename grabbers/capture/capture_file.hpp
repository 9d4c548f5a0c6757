// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "grabbers/capture/pcap_records.hpp"
#include "grabbers/capture/pcapng_blocks.hpp"

namespace crisp::capture {

/// The packets of a pcap or pcapng file, one after the other; memory does not depend on the file's size. A
/// packet whose time lies by more than a second outside of its neighbours', while these are in order, has a
/// damaged stamp: it is dropped and counted. One that is earlier than both of its neighbours by less came no
/// earlier than the packet before it, and gets that one's time: packets are written down as they come, and a
/// single stamp that is too early would bend the clock of its device, where one that is late does nothing.
class CaptureFile {
 public:
  /// A position from which a capture can be read.
  struct Place {
    std::uint64_t offset = 0;  ///< [bytes]
    std::optional<PcapngBlocks::Section> section = {};
  };

  /// @param interrupted  as ByteStream's
  /// @throws Error if the file cannot be read or is no capture
  explicit CaptureFile(const std::filesystem::path& path, std::function<bool()> interrupted = {})
      : CaptureFile(path, {}, kToTheEnd, std::move(interrupted)) {}
  /// A part of it: from a place to before another one [bytes].
  CaptureFile(const std::filesystem::path& path, const Place& from, std::uint64_t end,
              std::function<bool()> interrupted = {});
  static constexpr std::uint64_t kToTheEnd = std::numeric_limits<std::uint64_t>::max();

  /// From now on no stamp counts as damaged: survey_capture() separates those of several clocks.
  void keep_all_stamps() { keeps_all_ = true; }

  /// The next packet, valid until the next call; nullptr at the end of the file.
  const Packet* next();

  /// The position of the packet that next() gave.
  Place place() const;

  const Counts& losses() const { return losses_; }
  const Counts& notes() const { return notes_; }
  std::uint64_t offset() const { return file_.offset(); }  ///< [bytes] read so far
  std::uint64_t size() const { return file_.size(); }      ///< [bytes] of the file; 0 for a pipe

 private:
  struct Slot {  ///< a packet with bytes of its own
    Packet packet;
    wire::Bytes bytes;
    std::uint64_t offset = 0;  ///< [bytes] in the file
    bool full = false;
  };

  void load(Slot& slot);
  bool stamp_is_damaged() const;
  std::int64_t earliest_receipt() const;  ///< of the current packet: its time, if it is not too early [ns]

  FileWindow file_;
  Counts losses_;
  Counts notes_;
  std::variant<std::monostate, PcapRecords, PcapngBlocks> records_;
  Slot current_, ahead_;
  std::uint64_t end_;  ///< [bytes] in the file
  bool begun_ = false;
  bool keeps_all_ = false;
  std::optional<std::int64_t> before_ns_;  ///< time of the packet before the current one
};

}  // namespace crisp::capture
