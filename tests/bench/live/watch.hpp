// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <crisp/cloud.hpp>
#include <crisp/measurements.hpp>
#include <crisp/stage.hpp>

namespace crisp {

double monotonic();  ///< [s]

/// Sorted values, for quantiles.
class Sorted {
 public:
  explicit Sorted(std::vector<double> values);
  double quantile(double share) const;  ///< 0 if there are no values

 private:
  std::vector<double> values_;
};

/// FNV-1a of all measurements, in their order.
class Fingerprint {
 public:
  void add(const Measurements& scan);
  bool operator==(const Fingerprint&) const = default;

  std::uint64_t scans = 0;

 private:
  template <class T>
  void add(const std::vector<T>& values);
  std::uint64_t hash_ = 14'695'981'039'346'656'037U;
};

/// Watches what flows through a pipeline: how late points are, and what it costs.
class Watch {
 public:
  void given(const std::string& tag, const Item& item);

  /// [s] from the receipt of each telegram to its points. Scans of the first two seconds, before their clocks
  /// are used, are left out.
  const std::vector<double>& latencies() const { return latencies_; }
  double elapsed() const { return last_ - begun_; }  ///< [s] from the first item to the last
  double cpu() const;                                ///< [s] of this process since the first item
  /// The most in each tenth of the time.
  std::string memory_in_tenths() const;

  std::uint64_t scans = 0, readings = 0, points = 0;
  Fingerprint fingerprint;
  Cloud sample;  ///< one in a thousand points

 private:
  void arrive(const Cloud& cloud);
  void measure_memory();

  std::map<std::uint16_t, std::deque<std::int64_t>> waiting_;  ///< by laser: [ns] receipts of its scans
  std::vector<double> latencies_;
  std::vector<double> memory_;                                 ///< [MiB] each second
  double begun_ = 0, begun_cpu_ = 0, checked_ = 0, last_ = 0;  ///< [s]
};

/// A thread that only sleeps: how late the machine wakes it is what no program on it can help.
class Sleeper {
 public:
  /// [s] by which each sleep of 5 ms was too long. Ends it.
  std::vector<double> late();

 private:
  std::vector<double> late_;
  std::jthread thread_{[this](const std::stop_token& stop) { sleep(stop); }};
  void sleep(const std::stop_token& stop);
};

}  // namespace crisp
