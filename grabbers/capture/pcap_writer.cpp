// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/pcap_writer.hpp"

#include <fmt/format.h>
#include <pcap/pcap.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "grabbers/capture/pcap_records.hpp"
#include "pipeline/data/error.hpp"
#include "pipeline/files/atomic_file.hpp"

namespace crisp {
namespace {

constexpr std::uint64_t kRecordHeader = 16;
constexpr int kSnapshot = 262144;  // what tcpdump writes by default

struct Free {
  void operator()(pcap_t* p) const { pcap_close(p); }
  void operator()(pcap_dumper_t* p) const { pcap_dump_close(p); }
  void operator()(std::FILE* p) const { std::fclose(p); }
};
using Pcap = std::unique_ptr<pcap_t, Free>;

Error cannot_write(const std::filesystem::path& path, int error) {
  return Error(fmt::format("cannot write the capture {}: {}", path.string(), std::strerror(error)),
               "check the folder, its permissions and the space on the disk");
}

/// Length of the whole records of an existing capture.
std::uint64_t whole_records(const std::filesystem::path& path) {
  char message[PCAP_ERRBUF_SIZE] = "";
  std::unique_ptr<std::FILE, Free> raw(std::fopen(path.c_str(), "rb"));
  std::uint32_t magic = 0;
  constexpr std::uint32_t kNanosecondMagic = 0xa1b23c4d;  // in this machine's byte order
  const bool same_kind =
      raw && std::fread(&magic, sizeof magic, 1, raw.get()) == 1 && magic == kNanosecondMagic;
  if (same_kind) std::rewind(raw.get());
  const Pcap pcap(
      same_kind ? pcap_fopen_offline_with_tstamp_precision(raw.get(), PCAP_TSTAMP_PRECISION_NANO, message)
                : nullptr);
  if (!pcap || pcap_datalink(pcap.get()) != DLT_EN10MB) {
    throw Error(
        fmt::format("{} exists and cannot be continued: it is no nanosecond Ethernet pcap", path.string()),
        "give another name, or remove the file");
  }
  static_cast<void>(raw.release());  // pcap_close() closes it
  std::uint64_t length = kPcapFileHeader;
  pcap_pkthdr* header = nullptr;
  const u_char* data = nullptr;
  while (pcap_next_ex(pcap.get(), &header, &data) == 1) length += kRecordHeader + header->caplen;
  return length;
}

}  // namespace

struct PcapWriter::File {
  std::filesystem::path path;            ///< that is written
  std::unique_ptr<AtomicFile> replaced;  ///< whose aside() that is, when replacing
  Pcap pcap;
  std::unique_ptr<pcap_dumper_t, Free> dump;
  std::uint64_t length = kPcapFileHeader;

  std::FILE* stream() const { return pcap_dump_file(dump.get()); }

  /// Cuts off what was written only in part, and says why.
  [[noreturn]] void fail() {
    const int error = errno;
    dump.reset();
    try {
      std::filesystem::resize_file(path, whole_records(path));
    } catch (const std::exception&) {  // there is not even a header: what failed first is what is told
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
  }
  const bool continued =
      !f.replaced && std::filesystem::exists(f.path) && std::filesystem::file_size(f.path) > 0;
  if (continued) {
    f.length = whole_records(f.path);
    std::filesystem::resize_file(f.path, f.length);
  }
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

void PcapWriter::write(std::int64_t time_ns, ByteView frame) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (frame.size() > kSnapshot || time_ns < 0 || time_ns / kSecond > 0xFFFFFFFFLL) {
    throw Error(
        fmt::format("a frame of {} bytes at {} ns has no place in a pcap file", frame.size(), time_ns),
        "frames have at most 262144 bytes and times lie between 1970 and 2106");
  }
  auto& f = *file_;
  if (!f.dump) throw Error("a capture that was closed cannot be written to");
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
  if (f.replaced) f.replaced->commit();
}

}  // namespace crisp
