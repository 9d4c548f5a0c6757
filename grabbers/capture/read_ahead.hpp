// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <crisp/capture_reader.hpp>

namespace crisp::capture {

/// Some hundred items of a capture, one after the other.
struct ReadBatch {
  struct Received {
    HubItem item;
    std::int64_t first_ns = 0;  ///< [ns since the Unix epoch] CaptureReader::first_ns() when it came
  };
  std::vector<Received> items;  ///< none: the capture ended, or was interrupted
  double progress = 0;          ///< CaptureReader::progress() after the last
};

/// Reads the next batch. @throws Error as CaptureReader::next
ReadBatch read_batch(CaptureReader& reader);

/// Reads a capture in a thread of its own, so that decoding and whatever is done with the items overlap.
/// Batches come in the order, and with the contents, that read_batch() gives; memory stays bounded.
class ReadAhead {
 public:
  /// @param reader lives longer than this, and is left alone until next() gave an empty batch
  explicit ReadAhead(CaptureReader& reader);
  /// Ends the reading, wherever it is.
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// The next batch, waited for if need be. @throws Error as read_batch
  ReadBatch next();

 private:
  void read();
  bool put(ReadBatch batch);

  CaptureReader& reader_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ReadBatch> ready_;
  std::size_t ready_bytes_ = 0;
  bool stopped_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace crisp::capture
