// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "grabbers/wire/bytes.hpp"
#include "grabbers/wire/cola.hpp"
#include "tests/fuzz/item_script.hpp"
#include "tests/grabbers/capture/capture_bytes.hpp"

namespace crisp {

/// The capture that a script of bytes describes: the telegrams of an ItemScript as frames on the hub's
/// network, all of them valid, with edits of the traffic and of the file. Any bytes are a script:
///
/// - byte 0: language (bit 0: CoLa-A), number of edits (bits 1 to 3), free for others (bits 4 to 7);
/// - four bytes for each edit: operation, where it begins, how long it is (1/256 of all items or frames), and
/// an
///   argument;
/// - the ItemScript.
///
/// Operations (modulo their number) on the traffic:
///
/// - 0: the laser `argument` connects anew where the edit begins
/// - 1: what the device `argument` sends comes from an address that the rig does not have
/// - 2: what the laser `argument` sends comes from the address of the next one
///
/// and on the frames:
///
/// - 3: they are lost
/// - 4: they come twice
/// - 5: their first half comes behind the second
/// - 6: ten parts of them come in reverse order
/// - 7: their times are off (jump_of argument)
/// - 8: those of the laser `argument` are 37 s ahead
class CaptureScript {
 public:
  explicit CaptureScript(std::span<const std::uint8_t> script);

  /// The pcap file.
  wire::Bytes file();
  /// Readable scans with echoes that each laser of the rig sent, each once.
  const std::array<std::size_t, 3>& scans() const { return scans_; }
  /// Whether an edit may take scans away before they are on the network.
  bool is_lossy() const;

 private:
  enum class Operation : std::uint8_t {
    reconnect,
    unknown_address,
    same_address,
    lose,
    repeat,
    swap,
    reverse_parts,
    shift,
    shift_laser,
  };
  static constexpr std::size_t kOperations = 9;
  struct Edit {
    Operation operation;
    std::size_t begin, end;  ///< [1/256 of all]
    std::uint8_t argument;
  };
  class Network;

  bool covers(const Edit& edit, std::size_t index, std::size_t all) const;
  void send(const ItemSequence& items, std::size_t index, Network& network);
  void apply(const Edit& edit, std::vector<Frame>& frames) const;

  ColaLanguage language_;
  std::vector<Edit> edits_;
  std::span<const std::uint8_t> items_;
  std::array<std::size_t, 3> scans_{};
  std::array<std::optional<std::uint16_t>, 3> counters_;  ///< of the scans that were sent last
};

}  // namespace crisp
