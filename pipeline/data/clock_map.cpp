// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>

#include <crisp/clock_map.hpp>

#include "pipeline/data/internal_error.hpp"

namespace crisp {
namespace {

void require_ascending(const ClockPiece& before, const ClockPiece& next) {
  if (!(next.device_begin > before.device_begin)) {
    throw data::internal_error("the pieces of a clock map do not ascend in device time");
  }
}

}  // namespace

ClockPieces::ClockPieces(const ClockPiece& first, const std::vector<ClockPiece>& others) : pieces_{first} {
  for (const ClockPiece& piece : others) append(piece);
}

void ClockPieces::append(const ClockPiece& piece) {
  require_ascending(pieces_.back(), piece);
  pieces_.push_back(piece);
}

void ClockPieces::replace_last(const ClockPiece& piece) {
  if (pieces_.size() > 1) require_ascending(pieces_.end()[-2], piece);
  pieces_.back() = piece;
}

bool ClockPieces::drop_last() {
  if (pieces_.size() < 2) return false;
  pieces_.pop_back();
  return true;
}

double ClockMap::to_hub(double device_time) const {
  auto next = std::upper_bound(pieces.begin(), pieces.end(), device_time,
                               [](double t, const ClockPiece& piece) { return t < piece.device_begin; });
  const ClockPiece& piece = next == pieces.begin() ? pieces.front() : *std::prev(next);
  return piece.hub_begin + piece.rate * (device_time - piece.device_begin);
}

double ClockMap::skew_ppm() const {
  const double duration = device_end - pieces.front().device_begin;
  if (duration <= 0) return 1e6 * (pieces.front().rate - 1);
  double sum = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double end = i + 1 < pieces.size() ? pieces[i + 1].device_begin : device_end;
    sum += (pieces[i].rate - 1) * (end - pieces[i].device_begin);
  }
  return 1e6 * sum / duration;
}

}  // namespace crisp
