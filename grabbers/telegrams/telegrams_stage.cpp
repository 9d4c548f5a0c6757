// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/telegrams/telegrams_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <istream>

#include "grabbers/capture/loss_warnings.hpp"
#include "grabbers/devices/device_log.hpp"
#include "grabbers/devices/framing_losses.hpp"
#include "grabbers/devices/wired_encoder.hpp"
#include "grabbers/telegrams/sick_scan_xd_json.hpp"
#include "pipeline/files/byte_stream.hpp"

namespace crisp::telegrams {
namespace {

/// Which laser of the rig is meant; nothing if there is none of that name.
std::optional<std::size_t> laser_named(const std::string& name, const Rig& rig) {
  if (name.empty()) return 0;
  const auto found = std::ranges::find(rig.lasers, name, &RigLaser::name);
  if (found == rig.lasers.end()) return std::nullopt;
  return static_cast<std::size_t>(found - rig.lasers.begin());
}

}  // namespace

void TelegramsStage::describe(StageDescription<TelegramsStage>& d) {
  d.name("grabber.telegrams").summary("reads scans of a SICK laser from a list of its telegrams (JSON)");
  d.details(
      "Reads the lists that pcap_json_converter of sick_scan_xd makes of captures for its emulator: the bytes of each telegram in hexadecimal, and the receipt time [s] of its first packet since the recording's start. They hold no addresses: all telegrams are of one laser of the rig. Readings of the plate come of them where its encoder is wired to that laser (`encoder_of` in the rig). Damaged, repeated and missing telegrams are counted, as for captures.");
  d.gives<Scan>().gives<PlateReading>();
  d.option("file", &TelegramsStage::file_, "the list").required();
  d.option("laser", &TelegramsStage::laser_, "name of the laser in the rig; empty: the first");
}

void TelegramsStage::check(const RunSettings& run) const {
  if (!laser_named(laser_, run.rig)) {
    throw Error("the rig has no laser " + laser_, "give the name of one that it has");
  }
}

void TelegramsStage::process(const Inputs&, Outputs& out, Context& context) {
  files::ByteStream stream(file_, [&context] { return context.interrupted(); });
  files::ByteStreamBuffer buffer(stream);
  std::istream text(&buffer);
  text.exceptions(std::ios::badbit);
  context.reads(file_);
  Counts losses;
  const std::size_t laser = *laser_named(laser_, context.rig());
  const RigLaser& own = context.rig().lasers.at(laser);
  devices::DeviceLog log(DeviceKind::Laser, own.name, own.address, static_cast<std::uint16_t>(laser));
  std::optional<devices::WiredEncoder> encoder;
  if (context.rig().plate.encoder_of) encoder.emplace(context.rig());
  wire::ColaFramer framer;
  const auto take = [&](const wire::ColaFrame& frame) {
    auto scan = log.take(frame, EncoderWidths::Position32);
    if (!scan) return;
    if (const auto reading = encoder ? encoder->read(*scan, EncoderWidths::Position32) : std::nullopt)
      out.give(*reading);
    out.give(std::move(scan));
  };
  std::uint64_t telegrams = 0;
  read_telegram_list(text, file_.string(), losses, [&](const ListedTelegram& telegram) {
    framer.feed(telegram.bytes, telegram.time_ns, take);
    constexpr std::uint64_t kReportEvery = 1000;
    if (telegrams++ % kReportEvery == 0)
      context.progress(Progress{static_cast<double>(telegrams), 0, "telegrams", "reading telegrams"});
  });
  framer.gap(take);
  devices::note_framing(framer.counts(), log);
  const DeviceStatistics statistics = log.statistics();
  for (auto& caveat : capture::lost_devices({.devices = {statistics}}))
    context.mark_untrusted(std::move(caveat));
  for (auto& warning : capture::loss_warnings({.devices = {statistics}}, file_.filename().string())) {
    context.warn(std::move(warning));
  }
  for (const auto& [what, n] : losses.all()) context.count(what, n);
  for (const auto& [what, n] : statistics.losses.all()) context.count(what, n);
  for (const auto& [what, n] : statistics.notes.all()) context.count(what, n);
  context.report({{"telegrams", telegrams}, {"scans", statistics.items}});
  context.print(fmt::format("{} scans of {} in {} telegrams", statistics.items, own.name, telegrams));
  if (statistics.items == 0) {
    throw Error(file_.string() + " holds no scan", "check that it holds LMDscandata telegrams of a laser");
  }
}

}  // namespace crisp::telegrams
