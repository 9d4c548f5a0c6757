// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/gps_time.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace crisp::write {
namespace {

using std::chrono::sys_days;
using std::chrono::year_month_day;

constexpr sys_days day(int year, unsigned month, unsigned in_month) {
  return sys_days(
      year_month_day(std::chrono::year(year), std::chrono::month(month), std::chrono::day(in_month)));
}

constexpr sys_days kGpsEpoch = day(1980, 1, 6);

/// The days with whose begin GPS time ran one second farther ahead of UTC (IERS Bulletin C).
constexpr std::array kLeaps = {
    day(1981, 7, 1), day(1982, 7, 1), day(1983, 7, 1), day(1985, 7, 1), day(1988, 1, 1), day(1990, 1, 1),
    day(1991, 1, 1), day(1992, 7, 1), day(1993, 7, 1), day(1994, 7, 1), day(1996, 1, 1), day(1997, 7, 1),
    day(1999, 1, 1), day(2006, 1, 1), day(2009, 1, 1), day(2012, 7, 1), day(2015, 7, 1), day(2017, 1, 1)};

}  // namespace

std::optional<double> adjusted_gps_time(std::uint64_t unix_us) {
  using std::chrono::microseconds;
  const std::chrono::sys_time<microseconds> instant{microseconds(static_cast<std::int64_t>(unix_us))};
  if (instant < kGpsEpoch) return std::nullopt;
  constexpr std::int64_t kMicro = 1'000'000;
  constexpr std::int64_t kAdjustment = 1'000'000'000 * kMicro;
  const auto leaps = std::ranges::upper_bound(kLeaps, instant) - kLeaps.begin();
  const std::int64_t us = (instant - kGpsEpoch).count() + leaps * kMicro - kAdjustment;
  return static_cast<double>(us) / kMicro;
}

}  // namespace crisp::write
