// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/io/grabber.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <crisp/hub_item.hpp>

namespace crisp {

/// Adapts any source of items to a pcl::Grabber: a thread pulls them and calls the registered callbacks, in
/// the order of their receipt. Signals:
///
///     void(const std::shared_ptr<const crisp::Scan>&)
///     void(const crisp::PlateReading&)
///
/// The grabber ends by itself when the source does; start() then begins anew. A grabber that gives more
/// (clouds) derives from it, creates its signal and overrides take().
///
/// start(), stop() and wait() may be called from any thread, stop() also from a callback.
class SourceGrabber : public ::pcl::Grabber {
 public:
  /// The signal of a scan.
  using ScanCallback = void(const std::shared_ptr<const Scan>&);
  /// The signal of an encoder reading.
  using ReadingCallback = void(const PlateReading&);
  /// Makes a source of items. @throws Error if it cannot be opened
  using Open = std::function<std::unique_ptr<ItemSource>()>;

  /// @param open makes the source; called by each start()
  SourceGrabber(std::string name, Open open);
  SourceGrabber(const SourceGrabber&) = delete;
  SourceGrabber& operator=(const SourceGrabber&) = delete;
  /// A class that overrides take() calls stop() in its own destructor.
  ~SourceGrabber() noexcept override;

  /// Begins to grab; nothing if it is running. @throws what opening the source throws
  void start() override;
  /// Ends at once, but for a callback that is being called: no callback is called any more when it returns,
  /// unless it was called from one.
  void stop() override;
  /// Blocks until the source has ended or stop() was called. Not from a callback.
  void wait();

  /// Whether the source is being read.
  bool isRunning() const override { return running_; }
  /// The name that the constructor was given.
  std::string getName() const override { return name_; }
  /// [Hz] Scans a second, all lasers together, by the hub's clock; 0 before the second scan.
  float getFramesPerSecond() const override { return frames_per_second_; }

  /// The error of the source or of a callback that ended the last run early; null if there was none.
  std::exception_ptr error() const;

 protected:
  /// Called for each item, from the grabber's thread: emits its signal.
  virtual void take(const HubItem& item);
  /// Called when the source has ended by itself, from the grabber's thread.
  virtual void end() {}

 private:
  void run(ItemSource& source);
  void pull(ItemSource& source);
  void count(const HubItem& item);

  std::string name_;
  Open open_;
  boost::signals2::signal<ScanCallback>* scan_signal_;
  boost::signals2::signal<ReadingCallback>* reading_signal_;

  mutable std::mutex mutex_;  ///< of what follows, and of what ends a run
  std::condition_variable ended_;
  std::unique_ptr<ItemSource> source_;
  std::thread thread_;
  std::exception_ptr error_;
  std::atomic<bool> stopping_ = false;
  std::atomic<bool> running_ = false;

  std::uint64_t scans_ = 0;
  std::int64_t first_scan_ns_ = 0;
  std::atomic<float> frames_per_second_ = 0;
};

}  // namespace crisp
