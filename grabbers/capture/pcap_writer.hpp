// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "grabbers/wire/bytes.hpp"

namespace crisp::capture {

/// Treatment of the file under its name while it is being written.
enum class PcapMode : std::uint8_t {
  Replace,  ///< written aside and renamed by close(): never a half-written file under the name
  Grow,  ///< written in place, behind what a file of the same kind already holds; a record that a crash left
         ///< half written at its end is cut off first, and nothing else
};

/// Writes Ethernet frames into a pcap file with nanosecond stamps, as tcpdump would.
class PcapWriter {
 public:
  /// @throws Error if the file cannot be written, or (Grow) exists and is no nanosecond Ethernet pcap of this
  ///         machine's byte order, or one that cannot be continued (PcapExtent)
  PcapWriter(std::filesystem::path path, PcapMode mode);
  ~PcapWriter();  ///< closes a growing file; drops a replacing one that was not closed
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;
  PcapWriter(PcapWriter&&) noexcept;
  PcapWriter& operator=(PcapWriter&&) noexcept;

  /// Appends one record.
  /// @param time_ns [ns since the Unix epoch] 0 … 2106-02-07
  /// @throws Error if the disk is full; the file then ends with the last whole record
  void write(std::int64_t time_ns, wire::ByteView frame);

  /// Puts everything on the disk. @throws Error as write()
  void flush();

  /// Flushes, closes, and gives a replacing file its name. @throws Error as write()
  void close();

  std::uint64_t bytes() const;  ///< the file's length so far

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace crisp::capture
