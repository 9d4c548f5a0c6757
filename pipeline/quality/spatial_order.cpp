// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::quality {
namespace {

constexpr int kBits = 21;              // a coordinate's share of a key
constexpr int kFineBits = 4;           // of these, the ones within a cell
constexpr std::size_t kBlock = 65536;  // points

double median_of_a_sample(std::span<const double> values) {
  const std::size_t stride = values.size() / 1024 + 1;
  std::vector<double> sample;
  for (std::size_t i = 0; i < values.size(); i += stride) sample.push_back(values[i]);
  return statistics::median_in_place(sample);
}

/// A coordinate's 21 bits, two zeros after each.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

/// Inverse of spread().
std::uint64_t gather(std::uint64_t bits) {
  bits &= 0x1249249249249249;
  bits = (bits | bits >> 2) & 0x10c30c30c30c30c3;
  bits = (bits | bits >> 4) & 0x100f00f00f00f00f;
  bits = (bits | bits >> 8) & 0x1f0000ff0000ff;
  bits = (bits | bits >> 16) & 0x1f00000000ffff;
  return (bits | bits >> 32) & 0x1fffff;
}

std::uint64_t interleave(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return spread(x) | spread(y) << 1 | spread(z) << 2;
}

/// The number of the fine cell along one axis, for each point; the lowest whole cell begins at 0, which is
/// at `low` [m].
std::vector<std::uint32_t> fine_cells(std::span<const double> values, double fine_side, double& low) {
  constexpr double kMiddle = 1 << (kBits - 1);
  constexpr double kLast = (1 << kBits) - 1;
  const double median = median_of_a_sample(values);
  std::vector<std::uint32_t> cells(values.size());
  std::vector<std::uint32_t> lows(blocks_of(values.size(), kBlock));
  for_blocks(values.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::uint32_t lowest = 1U << kBits;
    for (std::size_t i = begin; i < end; ++i) {
      cells[i] =
          static_cast<std::uint32_t>(std::clamp((values[i] - median) / fine_side + kMiddle, 0.0, kLast));
      lowest = std::min(lowest, cells[i]);
    }
    lows[block] = lowest;
  });
  // Few leading bits make a short sort; whole cells, so that cells stay what they are.
  const std::uint32_t lowest = *std::ranges::min_element(lows) >> kFineBits << kFineBits;
  for_blocks(values.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) cells[i] -= lowest;
  });
  low = median + (lowest - kMiddle) * fine_side;
  return cells;
}

struct Entry {
  std::uint64_t key;
  std::uint32_t index;
};

/// Sorts by one digit of the key, keeping the order of equal ones: each block of entries counts its digits,
/// and so knows where to put them.
void sort_by_digit(std::span<const Entry> entries, int shift, int bits, std::span<Entry> sorted) {
  const std::size_t digits = std::size_t{1} << bits;
  const auto digit = [=](const Entry& entry) { return entry.key >> shift & (digits - 1); };
  std::vector<std::size_t> first(blocks_of(entries.size(), kBlock) * digits);
  for_blocks(entries.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++first[block * digits + digit(entries[i])];
  });
  std::size_t total = 0;
  for (std::size_t d = 0; d < digits; ++d) {
    for (std::size_t k = d; k < first.size(); k += digits) total += std::exchange(first[k], total);
  }
  for_blocks(entries.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      sorted[first[block * digits + digit(entries[i])]++] = entries[i];
  });
}

/// Entries that are yet to be written: memory is new to whichever thread comes first, not all to one.
using Entries = std::unique_ptr<Entry[]>;
Entries unwritten(std::size_t n) { return std::make_unique_for_overwrite<Entry[]>(n); }

void radix_sort(Entries& own, std::size_t n) {
  std::uint64_t used = 0;
  for (const Entry& entry : std::span(own.get(), n)) used |= entry.key;
  Entries other = unwritten(n);
  const int bits = n < 16384 ? 8 : 11;  // to count few entries by many digits takes longer
  for (int shift = 0; shift < 64 && used >> shift != 0; shift += bits) {
    sort_by_digit({own.get(), n}, shift, bits, {other.get(), n});
    own.swap(other);
  }
}

}  // namespace

CellLattice::Cell CellLattice::cell(double x, double y, double z) const {
  const auto along = [this](double value, std::size_t axis) {
    const double sides = std::clamp((value - low.at(axis)) / side, -1e9, 1e9);
    const auto whole = static_cast<std::int64_t>(sides);
    return sides < static_cast<double>(whole) ? whole - 1 : whole;
  };
  return {along(x, 0), along(y, 1), along(z, 2)};
}

std::uint64_t cell_key(const CellLattice::Cell& cell) {
  const auto outside = [](std::int64_t along) { return along < 0 || along >= 1 << (kBits - kFineBits); };
  if (std::ranges::any_of(cell, outside)) return ~std::uint64_t{0};
  return interleave(static_cast<std::uint64_t>(cell[0]), static_cast<std::uint64_t>(cell[1]),
                    static_cast<std::uint64_t>(cell[2]));
}

CellLattice::Cell cell_of(std::uint64_t key) {
  return {static_cast<std::int64_t>(gather(key)), static_cast<std::int64_t>(gather(key >> 1)),
          static_cast<std::int64_t>(gather(key >> 2))};
}

SpatialOrder spatial_order(const PointsView& points, double side) {
  const std::size_t n = points.size();
  if (n >= std::numeric_limits<std::uint32_t>::max()) {
    throw Error("a cloud of 2^32 points or more is too large", "thin it, or split it");
  }
  SpatialOrder order;
  if (n == 0) return order;
  const double fine_side = side / (1 << kFineBits);
  order.lattice.side = side;
  const auto x = fine_cells(points.x, fine_side, order.lattice.low[0]);
  const auto y = fine_cells(points.y, fine_side, order.lattice.low[1]);
  const auto z = fine_cells(points.z, fine_side, order.lattice.low[2]);
  Entries entries = unwritten(n);
  for_blocks(n, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      entries[i] = {interleave(x[i], y[i], z[i]), static_cast<std::uint32_t>(i)};
    }
  });
  radix_sort(entries, n);
  order.index.resize(n);
  order.cell.resize(n);
  for_blocks(n, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      order.index[k] = entries[k].index;
      order.cell[k] = entries[k].key >> (3 * kFineBits);
    }
  });
  return order;
}

}  // namespace crisp::quality
