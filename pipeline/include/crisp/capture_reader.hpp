// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include <crisp/capture_statistics.hpp>
#include <crisp/hub_item.hpp>
#include <crisp/rig.hpp>
#include <crisp/scan.hpp>

namespace crisp {

/// Settings for parsing a capture.
struct CaptureSettings {
  EncoderWidths encoder_widths = EncoderWidths::Position32;  ///< of encoders that are wired to lasers
  double max_wait = 5;                     ///< [s] of capture time that a lost TCP segment is waited for
  std::function<bool()> interrupted = {};  ///< polled while a capture is read from a pipe: whether to give up
};

/// Reads scans and encoder readings from a capture of the hub's network interface, in the order in which the
/// hub received them: the time of the packet that completes a telegram. Only where the hub's clock itself
/// stepped back does the order follow the file; that is counted. Memory does not depend on the capture's
/// size. Damaged and missing data are counted by name; see statistics().
class CaptureReader final : public ItemSource {
 public:
  /// @throws Error if the file cannot be read or is no capture, or an address of the rig is none
  CaptureReader(const std::filesystem::path& file, const Rig& rig, const CaptureSettings& settings = {});
  ~CaptureReader() override;
  CaptureReader(const CaptureReader&) = delete;
  CaptureReader& operator=(const CaptureReader&) = delete;
  /// Goes on where the other reader was.
  CaptureReader(CaptureReader&&) noexcept;
  /// Goes on where the other reader was.
  CaptureReader& operator=(CaptureReader&&) noexcept;

  /// The next item of one of the rig's devices; nothing at the end of the capture.
  /// @throws Error if the disk fails
  std::optional<HubItem> next() override;

  void interrupt() override;

  /// Statistics so far; complete once next() gave nothing.
  CaptureStatistics statistics() const;

  double progress() const;        ///< 0 … 1, by the bytes of the file
  std::int64_t first_ns() const;  ///< [ns since the Unix epoch] time of the first packet; 0 before next()

 private:
  friend CaptureStatistics inspect_capture(const std::filesystem::path& file, const CaptureSettings& settings,
                                           const RigPlate& plate);
  struct Traffic;
  explicit CaptureReader(std::unique_ptr<Traffic> traffic);
  std::unique_ptr<Traffic> traffic_;
};

/// Checks that a rig's devices are distinguishable by their addresses.
/// @throws Error if an address is none, or two devices have the same
void check_addresses(const Rig& rig);

/// Describes a capture's content, from any sender: reads all of it without a rig, and recognises lasers and
/// plates by their telegrams. @throws Error as CaptureReader
/// @param plate  whose encoder is read if it sends lines of its own, which nothing else identifies
CaptureStatistics inspect_capture(const std::filesystem::path& file, const CaptureSettings& settings = {},
                                  const RigPlate& plate = {});

}  // namespace crisp
