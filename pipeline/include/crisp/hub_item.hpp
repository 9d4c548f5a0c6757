// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>

#include <crisp/scan.hpp>

namespace crisp {

/// An item received by the hub: a scan of a laser or an encoder reading.
using HubItem = std::variant<std::shared_ptr<const Scan>, PlateReading>;

/// [ns since the Unix epoch] When the hub received it.
inline std::int64_t receipt_ns(const HubItem& item) {
  const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
  return scan != nullptr ? (*scan)->receipt_ns : std::get<PlateReading>(item).receipt_ns;
}

/// A sequential source of items: a capture, live devices, a simulator.
class ItemSource {
 public:
  ItemSource() = default;
  ItemSource(const ItemSource&) = delete;
  ItemSource& operator=(const ItemSource&) = delete;
  /// Goes on where the other source was.
  ItemSource(ItemSource&&) noexcept = default;
  /// Goes on where the other source was.
  ItemSource& operator=(ItemSource&&) noexcept = default;
  virtual ~ItemSource() = default;

  /// The next item, waited for if need be; nothing at the end, or once interrupt() was called.
  /// @throws Error if the source fails
  virtual std::optional<HubItem> next() = 0;

  /// Lets a next() that waits return at once. May be called from any thread, and again.
  virtual void interrupt() {}
};

}  // namespace crisp
