// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include <crisp/source_grabber.hpp>

namespace crisp {

SourceGrabber::SourceGrabber(std::string name, Open open)
    : name_(std::move(name)),
      open_(std::move(open)),
      scan_signal_(createSignal<ScanCallback>()),
      reading_signal_(createSignal<ReadingCallback>()) {}

SourceGrabber::~SourceGrabber() noexcept {
  SourceGrabber::stop();
  if (thread_.joinable()) thread_.join();
}

void SourceGrabber::start() {
  const std::lock_guard lock(mutex_);
  if (running_) return;
  if (thread_.joinable()) thread_.join();  // of a run that is over
  source_ = open_();
  error_ = nullptr;
  scans_ = 0;
  frames_per_second_ = 0;
  stopping_ = false;
  running_ = true;
  thread_ = std::thread([this] { run(*source_); });
}

void SourceGrabber::stop() {
  std::unique_lock lock(mutex_);
  stopping_ = true;
  if (running_) source_->interrupt();
  if (thread_.get_id() == std::this_thread::get_id()) return;  // a callback's: run() ends when it returns
  ended_.wait(lock, [this] { return !running_; });
}

void SourceGrabber::wait() {
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] { return !running_; });
}

std::exception_ptr SourceGrabber::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

void SourceGrabber::run(ItemSource& source) {
  std::exception_ptr error;
  try {
    pull(source);
  } catch (...) {  // from the source or a callback: reported by error(), since nobody could catch it here
    error = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  error_ = error;
  running_ = false;
  ended_.notify_all();
}

void SourceGrabber::pull(ItemSource& source) {
  while (!stopping_) {
    const auto item = source.next();
    if (stopping_) return;
    if (!item) return end();
    count(*item);
    take(*item);
  }
}

void SourceGrabber::count(const HubItem& item) {
  if (!std::holds_alternative<std::shared_ptr<const Scan>>(item)) return;
  const auto time = receipt_ns(item);
  if (scans_++ == 0) first_scan_ns_ = time;
  const double elapsed = 1e-9 * static_cast<double>(time - first_scan_ns_);
  if (elapsed > 0) frames_per_second_ = static_cast<float>(static_cast<double>(scans_ - 1) / elapsed);
}

void SourceGrabber::take(const HubItem& item) {
  if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
    (*scan_signal_)(*scan);
  } else {
    (*reading_signal_)(std::get<PlateReading>(item));
  }
}

}  // namespace crisp
