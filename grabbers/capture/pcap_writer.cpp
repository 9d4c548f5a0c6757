// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/pcap_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pcap/pcap.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "grabbers/capture/file_window.hpp"
#include "grabbers/capture/pcap_extent.hpp"
#include "grabbers/capture/pcap_records.hpp"
#include "pipeline/data/internal_error.hpp"

namespace crisp::capture {
namespace {

constexpr std::uint64_t kRecordHeader = 16;
constexpr int kSnapshot = 262144;  // what tcpdump writes by default

struct Free {
  void operator()(pcap_t* p) const { pcap_close(p); }
  void operator()(pcap_dumper_t* p) const { pcap_dump_close(p); }
};
using Pcap = std::unique_ptr<pcap_t, Free>;

Error cannot_write(const std::filesystem::path& path, int error) {
  return Error(fmt::format("cannot write the capture {}: {}", path.string(), std::strerror(error)),
               "check the folder, its permissions and the space on the disk");
}

/// End of the last whole record that this program wrote into the file from `begin` on.
std::uint64_t end_of_own_records(const std::filesystem::path& path, std::uint64_t begin) {
  FileWindow file(path);
  file.skip(begin);
  while (true) {
    const auto header = file.peek(kRecordHeader);
    if (header.size() < kRecordHeader) return file.offset();
    std::uint32_t captured = 0;
    std::memcpy(&captured, header.data() + 8, sizeof captured);
    const std::uint64_t size = kRecordHeader + captured;
    if (file.offset() + size > file.size()) return file.offset();
    file.skip(size);
  }
}

/// Cuts off a record that a crash left half written, and nothing else.
/// @return the length of the file
std::uint64_t prepare_to_continue(const std::filesystem::path& path) {
  const PcapExtent extent = pcap_extent(path);
  if (!extent.can_be_continued()) {
    throw Error(
        fmt::format(
            "{} is damaged: its last {} bytes are unreadable, and so would be anything written behind them",
            path.string(), extent.bytes - extent.whole),
        "give another name");
  }
  if (extent.whole < extent.bytes) std::filesystem::resize_file(path, extent.whole);
  return extent.whole;
}

}  // namespace

namespace {

/// Keeps other writers out of a file that grows, in this process and others; those that replace it have one
/// each.
class WriterLock {
 public:
  explicit WriterLock(const std::filesystem::path& path) {
    std::error_code none;
    if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none))
      return;  // a pipe
    descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw cannot_write(path, errno);
    if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(descriptor_);
    throw Error(path.string() + " is being written by another recorder",
                "wait for its end, or give another name or folder");
  }
  ~WriterLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace

struct PcapWriter::File {
  std::filesystem::path path;            ///< that is written
  std::optional<WriterLock> lock;        ///< when growing
  std::unique_ptr<AtomicFile> replaced;  ///< whose aside() that is, when replacing
  Pcap pcap;
  std::unique_ptr<pcap_dumper_t, Free> dump;
  std::uint64_t begin = kPcapFileHeader;  ///< of what this program writes
  std::uint64_t length = kPcapFileHeader;

  std::FILE* stream() const { return pcap_dump_file(dump.get()); }

  /// Truncates an incomplete record, and throws the cause.
  [[noreturn]] void fail() {
    const int error = errno;
    dump.reset();
    try {
      std::filesystem::resize_file(path, end_of_own_records(path, begin));
    } catch (const std::exception&) {  // there is not even a header: the first failure is reported
    }
    throw cannot_write(path, error);
  }
};

PcapWriter::PcapWriter(std::filesystem::path path, PcapMode mode) : file_(std::make_unique<File>()) {
  auto& f = *file_;
  if (mode == PcapMode::Replace) {
    f.replaced = std::make_unique<AtomicFile>(std::move(path));
    f.path = f.replaced->aside();
  } else {
    f.path = std::move(path);
    f.lock.emplace(f.path);
    remove_record_of(f.path);
  }
  const bool continued =
      !f.replaced && std::filesystem::exists(f.path) && std::filesystem::file_size(f.path) > 0;
  if (continued) f.begin = f.length = prepare_to_continue(f.path);
  f.pcap.reset(pcap_open_dead_with_tstamp_precision(DLT_EN10MB, kSnapshot, PCAP_TSTAMP_PRECISION_NANO));
  errno = 0;
  f.dump.reset(continued ? pcap_dump_open_append(f.pcap.get(), f.path.c_str())
                         : pcap_dump_open(f.pcap.get(), f.path.c_str()));
  if (!f.dump) throw cannot_write(f.path, errno);
}

PcapWriter::~PcapWriter() = default;
PcapWriter::PcapWriter(PcapWriter&&) noexcept = default;
PcapWriter& PcapWriter::operator=(PcapWriter&&) noexcept = default;

std::uint64_t PcapWriter::bytes() const { return file_->length; }

void PcapWriter::write(std::int64_t time_ns, wire::ByteView frame) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (frame.size() > kSnapshot || time_ns < 0 || time_ns / kSecond > 0xFFFFFFFFLL) {
    throw Error(
        fmt::format("a frame of {} bytes at {} ns cannot be stored in a pcap file", frame.size(), time_ns),
        "frames have at most 262144 bytes and times lie between 1970 and 2106");
  }
  auto& f = *file_;
  if (!f.dump) throw data::internal_error("a closed capture cannot be written to");
  pcap_pkthdr header{};
  header.ts.tv_sec = time_ns / kSecond;
  header.ts.tv_usec = time_ns % kSecond;  // nanoseconds, by the file's precision
  header.caplen = header.len = static_cast<bpf_u_int32>(frame.size());
  pcap_dump(reinterpret_cast<u_char*>(f.dump.get()), &header, frame.data());
  if (std::ferror(f.stream()) != 0) f.fail();
  f.length += kRecordHeader + frame.size();
}

void PcapWriter::flush() {
  auto& f = *file_;
  if (!f.dump) return;
  if (pcap_dump_flush(f.dump.get()) != 0 || std::ferror(f.stream()) != 0) f.fail();
  if (fdatasync(fileno(f.stream())) != 0 && errno != EINVAL) f.fail();  // EINVAL: a pipe
}

void PcapWriter::close() {
  auto& f = *file_;
  if (!f.dump) return;
  flush();
  f.dump.reset();
  f.lock.reset();
  if (f.replaced) f.replaced->commit();
}

}  // namespace crisp::capture
