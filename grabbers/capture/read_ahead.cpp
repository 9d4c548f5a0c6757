// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/read_ahead.hpp"

#include <utility>

namespace crisp::capture {
namespace {

constexpr std::size_t kBatch = 256;  // items
// A clock's window of three lasers: while its measurements are assembled, the next is read.
constexpr std::size_t kMaxAhead = std::size_t{64} << 20;  // [bytes]

std::size_t bytes_of(const ReadBatch& batch) {
  std::size_t bytes = batch.items.size() * sizeof(ReadBatch::Received);
  for (const auto& received : batch.items) {
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&received.item);
    if (scan == nullptr) continue;
    bytes += sizeof(Scan);
    for (const auto& echo : (*scan)->echoes) {
      bytes += sizeof(float) * (echo.ranges.size() + echo.remissions.size());
    }
  }
  return bytes;
}

}  // namespace

ReadBatch read_batch(CaptureReader& reader) {
  ReadBatch batch;
  batch.items.reserve(kBatch);
  while (batch.items.size() < kBatch) {
    auto item = reader.next();
    if (!item) break;
    batch.items.push_back({std::move(*item), reader.first_ns()});
  }
  batch.progress = reader.progress();
  return batch;
}

ReadAhead::ReadAhead(CaptureReader& reader) : reader_(reader), thread_([this] { read(); }) {}

ReadAhead::~ReadAhead() {
  reader_.interrupt();
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ReadAhead::read() {
  try {
    bool more = true;
    while (more) {
      auto batch = read_batch(reader_);
      more = !batch.items.empty();
      more = put(std::move(batch)) && more;
    }
  } catch (...) {
    {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
    changed_.notify_all();
  }
}

/// False if nobody takes any more.
bool ReadAhead::put(ReadBatch batch) {
  const auto bytes = bytes_of(batch);
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stopped_ || ready_.empty() || ready_bytes_ + bytes <= kMaxAhead; });
    if (stopped_) return false;
    ready_.push_back(std::move(batch));
    ready_bytes_ += bytes;
  }
  changed_.notify_all();
  return true;
}

ReadBatch ReadAhead::next() {
  ReadBatch batch;
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !ready_.empty() || failure_; });
    if (ready_.empty()) std::rethrow_exception(failure_);
    batch = std::move(ready_.front());
    ready_.pop_front();
    ready_bytes_ -= bytes_of(batch);
  }
  changed_.notify_all();
  return batch;
}

}  // namespace crisp::capture
