// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/statistics/random_stream.hpp"

#include <cmath>

namespace crisp::statistics {
namespace {

/// FNV-1a over the name, then the finalizer of splitmix64 so that near seeds give far streams.
std::uint64_t mix(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  std::uint64_t z = hash + seed * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) : engine_(mix(seed, name)) {}

double RandomStream::uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

double RandomStream::uniform(double low, double high) { return low + (high - low) * uniform(); }

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double u = 0;
  double v = 0;
  double s = 0;
  do {
    u = 2 * uniform() - 1;
    v = 2 * uniform() - 1;
    s = u * u + v * v;
  } while (s >= 1 || s == 0);
  const double scale = std::sqrt(-2 * std::log(s) / s);
  spare_ = v * scale;
  has_spare_ = true;
  return u * scale;
}

double RandomStream::exponential(double mean) { return -mean * std::log1p(-uniform()); }

bool RandomStream::chance(double probability) { return uniform() < probability; }

double RandomStream::sign() { return engine_() >> 63U == 0 ? -1 : 1; }

std::size_t RandomStream::below(std::size_t n) {
  // The remainder of the last, incomplete round of n would be drawn more often.
  const std::uint64_t incomplete = (0 - std::uint64_t{n}) % n;
  std::uint64_t drawn = engine_();
  while (drawn < incomplete) drawn = engine_();
  return drawn % n;
}

}  // namespace crisp::statistics
