// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/telegrams/telegrams_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "grabbers/capture/device_log.hpp"
#include "grabbers/capture/framing_losses.hpp"
#include "grabbers/capture/loss_warnings.hpp"
#include "grabbers/telegrams/telegram_list.hpp"

namespace crisp {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  if (!in || in.bad()) throw Error("cannot read " + file.string(), "is it there, and may it be read?");
  return text;
}

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
      "The lists are those that pcap_json_converter of sick_scan_xd makes of captures for its emulator: of "
      "each telegram of the dialogue its bytes in hexadecimal, and the time [s] since the recording began at "
      "which the first of its packets came in. There are no addresses in them: all is of one laser of the "
      "rig. "
      "What is damaged, repeated or missing is counted, as in captures.");
  d.gives<Scan>();
  d.option("file", &TelegramsStage::file_, "the list").required();
  d.option("laser", &TelegramsStage::laser_, "name of the laser in the rig; empty: the first");
}

void TelegramsStage::check(const RunSettings& run) const {
  if (!laser_named(laser_, run.rig)) {
    throw Error("the rig has no laser " + laser_, "give the name of one that it has");
  }
}

void TelegramsStage::process(const Inputs&, Outputs& out, Context& context) {
  const std::string text = text_of(file_);
  context.reads(file_);
  Counts losses;
  const auto telegrams = read_telegram_list(text, file_.string(), losses);
  const std::size_t laser = *laser_named(laser_, context.rig());
  const RigLaser& own = context.rig().lasers.at(laser);
  DeviceLog log(DeviceKind::Laser, own.name, own.address, static_cast<std::uint16_t>(laser));
  ColaFramer framer;
  const auto take = [&](const ColaFrame& frame) {
    if (auto scan = log.take(frame, EncoderWidths::Position32)) out.give(std::move(scan));
  };
  for (std::size_t k = 0; k < telegrams.size(); ++k) {
    framer.feed(telegrams[k].bytes, telegrams[k].time_ns, take);
    constexpr std::size_t kTellEvery = 1000;
    if (k % kTellEvery != 0) continue;
    if (context.interrupted()) return;
    context.progress(static_cast<double>(k) / static_cast<double>(telegrams.size()), "reading telegrams");
  }
  framer.gap(take);
  note_framing(framer.counts(), log);
  const DeviceStatistics statistics = log.statistics();
  for (auto& warning : loss_warnings({.devices = {statistics}}, file_.filename().string())) {
    context.warn(std::move(warning));
  }
  for (const auto& [what, n] : losses.all()) context.count(what, n);
  for (const auto& [what, n] : statistics.losses.all()) context.count(what, n);
  for (const auto& [what, n] : statistics.notes.all()) context.count(what, n);
  context.report({{"telegrams", telegrams.size()}, {"scans", statistics.items}});
  context.say(fmt::format("{} scans of {} in {} telegrams", statistics.items, own.name, telegrams.size()));
  if (statistics.items == 0) {
    throw Error(file_.string() + " holds no scan", "are LMDscandata telegrams of a laser in it?");
  }
}

}  // namespace crisp
