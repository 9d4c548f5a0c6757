// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/capture_stage.hpp"

#include <fmt/format.h>

#include "grabbers/capture/capture_report.hpp"
#include "grabbers/capture/captures_in.hpp"
#include "grabbers/capture/loss_warnings.hpp"
#include "grabbers/capture/read_ahead.hpp"
#include "grabbers/capture/unknown_devices.hpp"

namespace crisp::capture {
namespace {

/// For a plate of which nothing came, while a laser of the rig has an encoder.
std::string advice_on_encoders(const CaptureStatistics& statistics) {
  for (const auto& device : statistics.devices) {
    if (device.name.empty() || !device.shape.encoder) continue;
    return fmt::format(
        "; the telegrams of {} carry an encoder's counts: if it is the plate's, write encoder_of: {} for the plate in the rig, in place of its address",
        device.name, device.name);
  }
  return {};
}

}  // namespace

void CaptureStage::describe(StageDescription<CaptureStage>& d) {
  d.name("grabber.capture")
      .summary("reads scans and encoder readings from a capture of the hub's network interface");
  d.details(
      "A capture is a pcap or pcapng file as tcpdump, dumpcap or Wireshark write it, plain or compressed by gzip or zstd. The rig's addresses identify the lasers' TCP streams of CoLa-A or CoLa-B telegrams, and the plate's UDP datagrams or TCP stream of sentences. With `plate: {encoder_of: laser1}` the plate's readings are the encoder counts in the telegrams of that laser. Each item carries the time of the packet that completed it, and items come in the order of these times.\n\n"
      "A folder stands for all captures in it, one after the other in the order of their first packets: of one scanner in several places, or of one recording in several files.\n\n"
      "Where packet times go back, the file's parts are read in the order of their times, or time is continued if the hub's clock was set back.\n\n"
      "Damaged, lost, repeated and unknown data are counted by name; they never end the reading. Memory does not depend on the size of the capture.");
  d.gives<Scan>().gives<PlateReading>();
  d.option("file", &CaptureStage::file_, "capture, or folder of captures").required();
  d.option("begin", &CaptureStage::begin_, "start of the used part, after the first packet's receipt")
      .unit("s")
      .at_least(0);
  d.option("duration", &CaptureStage::duration_, "duration of the used part; auto: to the end")
      .unit("s")
      .at_least(0);
  d.option(
       "encoder", &CaptureStage::settings_, &CaptureSettings::encoder_widths,
       "width of the encoder's fields in scan telegrams, which differs between sources: a position of 32 bits with a signed speed, or 16 bits each")
      .choices({{"position32", EncoderWidths::Position32}, {"position16", EncoderWidths::Position16}});
  d.option("max_wait", &CaptureStage::settings_, &CaptureSettings::max_wait,
           "timeout for a missing TCP segment, in the capture's time")
      .unit("s")
      .range(0, 600);
}

void CaptureStage::check(const RunSettings& run) const { check_addresses(run.rig); }

void CaptureStage::process(const Inputs&, Outputs& out, Context& context) {
  const auto [files, left_out] = captures_in(file_);
  for (const auto& why : left_out) context.warn("left out: " + why + "; use an intact copy");
  std::uint64_t found = 0;
  std::vector<CaptureStatistics> captures;
  auto sections = nlohmann::json::array();
  for (const auto& file : files) {
    if (files.size() > 1) context.print(file.filename().string());
    const double done = static_cast<double>(sections.size()) / static_cast<double>(files.size());
    captures.push_back(read(file, done, 1 / static_cast<double>(files.size()), out, context));
    if (context.interrupted()) return;
    found += report(captures.back(), file, context);
    sections.push_back(to_json(captures.back()));
    sections.back()["file"] = file.string();
  }
  context.report(files.size() == 1 ? sections.front() : nlohmann::json{{"captures", sections}});
  const std::string others = unknown_devices(captures);
  if (!others.empty()) context.warn("not in the rig: " + others);
  if (found == 0) throw nothing_found(others);
  if (given_ == 0) throw nothing_left();
  for (auto& caveat : caveats_of_addresses(captures)) context.mark_untrusted(std::move(caveat));
}

Error CaptureStage::nothing_found(const std::string& others) const {
  return Error(fmt::format("{} holds no scan and no reading of the rig's devices", file_.string()),
               others.empty() ? "it holds no telegrams of any laser or plate: check the captured interface"
                              : "it holds " + others + ": correct the addresses and ports in the rig");
}

Error CaptureStage::nothing_left() const {
  const double length = 1e-9 * static_cast<double>(last_ns_ - *first_ns_);
  return Error(fmt::format("begin and duration select nothing of {}, which ends after {:.1f} s",
                           file_.string(), length),
               "reduce begin, or raise duration");
}

CaptureStatistics CaptureStage::read(const std::filesystem::path& file, double done, double share,
                                     Outputs& out, Context& context) {
  context.reads(file);
  CaptureSettings settings = settings_;
  settings.interrupted = [&context] { return context.interrupted(); };
  CaptureReader reader(file, context.rig(), settings);
  std::optional<ReadAhead> ahead;
  if (context.threads() > 1) ahead.emplace(reader);
  while (true) {
    const ReadBatch batch = ahead ? ahead->next() : read_batch(reader);
    if (batch.items.empty()) break;
    for (const auto& [item, first_ns] : batch.items) {
      refuse_overlap(first_ns, file);
      if (!first_ns_) first_ns_ = first_ns;
      give(item, out, context);
    }
    if (context.interrupted()) return {};
    context.progress(done + share * batch.progress, "reading the capture");
  }
  ahead.reset();
  CaptureStatistics statistics = reader.statistics();
  last_ns_ = statistics.last_ns;
  before_ = file;
  return statistics;
}

void CaptureStage::refuse_overlap(std::int64_t first_ns, const std::filesystem::path& file) const {
  if (before_.empty() || first_ns >= last_ns_) return;
  throw Error(fmt::format("{} begins before {} ends: they are of the same time", file.string(),
                          before_.filename().string()),
              "join captures of several interfaces with mergecap, and give each scanner a folder of its own");
}

void CaptureStage::give(const HubItem& item, Outputs& out, Context& context) {
  const double since_begin = 1e-9 * static_cast<double>(receipt_ns(item) - *first_ns_) - begin_;
  if ((begin_ > 0 && since_begin < 0) || (duration_ && since_begin >= *duration_)) {
    context.count("items outside of begin and duration");
    return;
  }
  ++given_;
  if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
    out.give(*scan);
  } else {
    out.give(std::get<PlateReading>(item));
  }
}

std::uint64_t CaptureStage::report(const CaptureStatistics& statistics, const std::filesystem::path& file,
                                   Context& context) {
  context.print(extent_of(statistics));
  context.print(device_table(statistics));
  for (const auto& [what, n] : statistics.losses.all()) context.count(what, n);
  for (auto& warning : loss_warnings(statistics, file.filename().string())) context.warn(std::move(warning));
  for (auto& caveat : lost_devices(statistics)) context.mark_untrusted(std::move(caveat));
  for (auto& caveat : address_conflicts(statistics)) context.mark_untrusted(std::move(caveat));
  std::uint64_t found = 0;
  for (const auto& device : statistics.devices) {
    if (device.name.empty()) {
      context.count(fmt::format("items of a {} that is not in the rig", title(device)), device.items);
      continue;
    }
    found += device.items;
    for (const auto& [what, n] : device.losses.all()) context.count(device.name + ": " + what, n);
    if (device.items == 0) {
      context.warn(fmt::format("{} holds {} of {}{}", file.filename().string(),
                               device.losses.all().empty() ? "nothing" : "no whole telegram", title(device),
                               device.kind == DeviceKind::Plate ? advice_on_encoders(statistics) : ""));
    }
  }
  return found;
}

}  // namespace crisp::capture
