// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/live/watch.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include <crisp/hub_item.hpp>

namespace crisp {
namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  double total = 0;
  double resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024 * 1024);
}

}  // namespace

double monotonic() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Sorted::Sorted(std::vector<double> values) : values_(std::move(values)) { std::ranges::sort(values_); }

double Sorted::quantile(double share) const {
  if (values_.empty()) return 0;
  return values_[static_cast<std::size_t>(share * static_cast<double>(values_.size() - 1))];
}

template <class T>
void Fingerprint::add(const std::vector<T>& values) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t i = 0; i < values.size() * sizeof(T); ++i) hash_ = (hash_ ^ bytes[i]) * 1'099'511'628'211U;
}

void Fingerprint::add(const Measurements& scan) {
  ++scans;
  add(scan.range);
  add(scan.mirror_angle);
  add(scan.time);
  add(scan.laser);
  add(scan.remission);
  add(scan.beam);
  add(std::vector<std::int64_t>{scan.epoch_ns});
}

void Watch::given(const std::string& tag, const Item& item) {
  if (const auto scan = item.as<Scan>()) {
    waiting_[scan->laser].push_back(scan->receipt_ns);
    ++scans;
  } else if (item.as<PlateReading>()) {
    ++readings;
  } else if (const auto measurements = item.as<Measurements>()) {
    fingerprint.add(*measurements);
  } else if (const auto cloud = item.as<Cloud>(); cloud && tag == "assemble.deskew") {
    arrive(*cloud);
  }
  if (scans + readings > 0) measure_memory();  // and not before the devices are there
}

void Watch::measure_memory() {
  const double now = monotonic();
  if (begun_ == 0) {
    begun_ = now;
    begun_cpu_ = cpu_seconds();
  }
  last_ = now;
  if (now - checked_ < 1) return;
  checked_ = now;
  memory_.push_back(resident_megabytes());
}

void Watch::arrive(const Cloud& cloud) {
  constexpr std::size_t kOneIn = 1000;
  if (cloud.empty()) return;
  for (std::size_t i = (kOneIn - points % kOneIn) % kOneIn; i < cloud.size(); i += kOneIn) {
    sample.push_back(cloud[i]);
  }
  points += cloud.size();
  auto& queue = waiting_[cloud.front().laser];
  if (queue.empty()) return;
  const double late = 1e-9 * static_cast<double>(now_ns() - queue.front());
  queue.pop_front();
  if (monotonic() - begun_ > 2) latencies_.push_back(late);
}

double Watch::cpu() const { return cpu_seconds() - begun_cpu_; }

std::string Watch::memory_in_tenths() const {
  constexpr std::size_t kTenths = 10;
  std::string text;
  for (std::size_t k = 0; k < kTenths; ++k) {
    const auto first = memory_.begin() + static_cast<std::ptrdiff_t>(k * memory_.size() / kTenths);
    const auto end = memory_.begin() + static_cast<std::ptrdiff_t>((k + 1) * memory_.size() / kTenths);
    if (first != end) text += fmt::format("{:.1f} ", *std::max_element(first, end));
  }
  return text + "MiB, the most in each tenth of the time";
}

std::vector<double> Sleeper::late() {
  thread_.request_stop();
  thread_.join();
  return std::move(late_);
}

void Sleeper::sleep(const std::stop_token& stop) {
  constexpr double kNap = 0.005;  // [s]
  while (!stop.stop_requested()) {
    const double begin = monotonic();
    std::this_thread::sleep_for(std::chrono::duration<double>(kNap));
    late_.push_back(monotonic() - begin - kNap);
  }
}

}  // namespace crisp
