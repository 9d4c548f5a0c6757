// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include <crisp/scan.hpp>

namespace crisp {

/// Scans and encoder readings in the order in which a hub received them.
using ItemSequence = std::vector<std::variant<std::shared_ptr<const Scan>, PlateReading>>;

inline constexpr std::size_t kPlateDevice = 3;  ///< behind three lasers

/// [s] A jump of a clock: none, back or forth, from what delays hide to what counters wrap by.
double jump_of(std::uint8_t argument);

/// The items that a script of bytes describes: traffic of three lasers and a plate, between changes of their
/// clocks, of the hub's, of their counters and of what they send. Any bytes are a script.
///
/// An operation is two bytes: the operation in the low half of the first, a device in its high half, and an
/// argument. Operations:
///
/// - 0: all devices that speak send for (argument + 1) · 20 ms
/// - 1: those in the bits of the argument speak
/// - 2: the hub's clock jumps (jump_of)
/// - 3: the clock of the device jumps (jump_of)
/// - 4: the clock of the device stands still, if the argument is odd
/// - 5: the counter of the device jumps by argument
/// - 6: the device's stamps are rounded to argument² µs
/// - 7: the hub's clock runs by (argument − 128) · 50 ppm
/// - 8: the delays of the device grow by argument ms
/// - 9: the receipts of the device are off (jump_of)
/// - 10: the device sends scans of kind `argument`
/// - 11: the encoder jumps by argument² steps
/// - 12: one item of random fields
/// - 13: the device sends each item argument times
/// - 14: the device sends each (argument + 1) · 10 ms
/// - 15: the device's scans have argument + 1 beams
class ItemScript {
 public:
  explicit ItemScript(std::span<const std::uint8_t> script);
  ItemSequence items();

 private:
  struct Device {
    double ahead = 0;  ///< [s] of its clock
    bool stands = false;
    double stood_at = 0;
    double step = 1e-6;  ///< [s] of its stamps
    double delay = 1e-3;
    double off = 0;  ///< [s] of its receipts
    unsigned copies = 1;
    std::size_t every = 4;  ///< [10 ms]
    std::size_t beams = 2;
    std::uint16_t count = 65'500;
    std::uint8_t kind = 0;
  };
  void operate(unsigned operation, std::size_t index, std::uint8_t argument);
  void send_for(double seconds);
  void send(std::size_t index, double now);
  void send_odd(std::size_t index, std::uint8_t seed);
  std::uint32_t stamp(Device& device, double now) const;
  std::int64_t receipt_ns(const Device& device, double now) const;

  std::span<const std::uint8_t> script_;
  std::array<Device, 4> devices_;  ///< the last is the plate
  unsigned speaking_ = 0xF;
  double now_ = 0;        ///< [s] true time
  double hub_ahead_ = 0;  ///< [s]
  double hub_rate_ = 0;
  std::uint32_t encoder_ahead_ = 0;
  ItemSequence items_;
};

}  // namespace crisp
