// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

namespace crisp::live {

/// One thing that is to happen later, in the thread that runs the io_context: set anew, what it was set to
/// before does not happen.
class RestartableTimer {
 public:
  explicit RestartableTimer(boost::asio::io_context& context) : timer_(context) {}

  void set(double seconds, const std::function<void()>& ring) {
    timer_.expires_after(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds)));
    timer_.async_wait([this, mine = ++current_, ring](const boost::system::error_code& failure) {
      if (!failure && mine == current_) ring();
    });
  }
  void cancel() {
    ++current_;
    timer_.cancel();
  }

 private:
  boost::asio::steady_timer timer_;
  std::uint64_t current_ = 0;  ///< what rings in the same turn of the loop as it is set anew is not heard
};

/// How long to wait before each try after one that failed: 0.1 s, then twice as long each time.
class BackOff {
 public:
  explicit BackOff(double longest) : longest_(longest) {}

  double next() { return std::exchange(pause_, std::min(2 * pause_, longest_)); }  ///< [s]
  void reset() { pause_ = kFirst; }

 private:
  static constexpr double kFirst = 0.1;  // [s]
  double longest_;
  double pause_ = kFirst;
};

}  // namespace crisp::live
