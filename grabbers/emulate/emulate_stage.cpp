// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/emulate/emulate_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>

#include <crisp/error.hpp>

namespace crisp::emulate {
namespace {

Address parse_address(const std::string& text) {
  const auto colon = text.rfind(':');
  Address address{.ip = text.substr(0, colon)};
  const char* end = text.data() + text.size();
  const char* begin = colon == std::string::npos ? end : text.data() + colon + 1;
  const auto read = std::from_chars(begin, end, address.port);
  if (read.ec != std::errc() || read.ptr != end || address.port == 0) {
    throw Error("\"" + text + "\" is no address with a port", "write it like 127.0.0.1:4000");
  }
  return address;
}

}  // namespace

void EmulateStage::describe(StageDescription<EmulateStage>& d) {
  d.name("emulate.rig")
      .summary("serves recorded scans and encoder readings as SICK devices on this machine's network");
  d.details(
      "Each laser of the rig becomes a TCP server at its address, which must be one of this machine, with CoLa-A and CoLa-B: login, configuration, states, errors, and scans for subscribers. The plate becomes a sender of datagrams. Items are sent at the pace of their receipt; nothing is sent before each laser has a client. While it waits it reports where the lasers listen, and which of them miss a client.\n\n"
      "Faults are drawn for each telegram from the run's seed. A laser that is `restarted` closes its connections, and its clock and counters begin at zero.\n\n"
      "A client that does not read misses scans, as with real devices; they are counted.");
  d.takes<Scan>().takes<PlateReading>();
  d.option("speed", &EmulateStage::settings_, &EmulatorSettings::speed,
           "speed relative to real time; 0: as fast as the clients read")
      .range(0, 1e6);
  d.option("wait", &EmulateStage::settings_, &EmulatorSettings::wait_for_clients,
           "whether to wait until each laser has a client");
  d.option("plate_to", &EmulateStage::plate_to_, "destination of the plate's datagrams");
  const auto share = [&](const char* name, double EmulatedFaults::*member, const char* help) {
    d.option(name, &EmulateStage::settings_, &EmulatorSettings::faults, member, help).range(0, 1);
  };
  share("dropped", &EmulatedFaults::dropped, "share of scans that are replaced by a closed connection");
  share("stalled", &EmulatedFaults::stalled, "share of telegrams that are preceded by a silence");
  d.option("stall", &EmulateStage::settings_, &EmulatorSettings::faults, &EmulatedFaults::stall, "that while")
      .unit("s")
      .range(0, 3600);
  share("split", &EmulatedFaults::split, "share of telegrams that are sent in pieces of any length");
  share("damaged", &EmulatedFaults::damaged, "share of scans and plate sentences with one flipped bit");
  share("restarted", &EmulatedFaults::restarted,
        "share of scans that are preceded by a restart of the laser");
  share("lost", &EmulatedFaults::lost, "share of the plate's datagrams that are lost");
  d.option("skews", &EmulateStage::settings_, &EmulatorSettings::faults, &EmulatedFaults::skews,
           "additional skew of each laser's clock: 100ppm")
      .unit("1")
      .range(-0.01, 0.01)
      .count(0, 1000);
  d.option("network", &EmulateStage::settings_, &EmulatorSettings::network,
           "whether lasers may listen at other addresses than loopback, open to the network");
}

void EmulateStage::check(const RunSettings&) const { parse_address(plate_to_); }

/// Reports where the lasers listen, and whenever it changes, which of them still miss a client.
void EmulateStage::report_missing(Context& context) {
  if (!context.is_watched()) return;
  auto missing = emulator_->without_client();
  if (missing_ == missing) return;
  StageStatus status;
  for (const RigLaser& laser : emulator_->rig().lasers) {
    if (missing_) break;
    status.events.push_back(
        fmt::format("{} listens at {}:{}", laser.name, laser.address.ip, laser.address.port));
  }
  status.line = missing.empty() ? "each laser has a client"
                                : fmt::format("waits for somebody who requests the scans of {}",
                                              fmt::join(missing, ", "));
  status.events.push_back(status.line);
  context.set_status(status);
  missing_ = std::move(missing);
}

/// Whether the run is interrupted; reports what is waited for.
bool EmulateStage::waits_no_longer(Context& context) {
  if (settings_.wait_for_clients && !emulator_->has_begun()) report_missing(context);
  return context.interrupted();
}

void EmulateStage::process(const Inputs& in, Outputs&, Context& context) {
  if (!emulator_) {
    settings_.plate_to = parse_address(plate_to_);
    settings_.faults.seed = context.seed();
    emulator_ = std::make_unique<Emulator>(context.rig(), settings_);
  }
  const auto interrupted = [&] { return waits_no_longer(context); };
  if (auto scan = in.share<Scan>()) {
    emulator_->send(std::move(scan), interrupted);
    ++scans_;
  } else if (!context.rig().plate.encoder_of) {  // else in the laser's telegrams
    emulator_->send(in.get<PlateReading>(), interrupted);
    ++readings_;
  }
}

void EmulateStage::finish(Outputs&, Context& context) {
  if (!emulator_) return;
  emulator_->finish([&] { return waits_no_longer(context); });
  const EmulatedLedger ledger = emulator_->ledger();
  context.count("scans missed by a client that did not read", ledger.missed);
  context.count("scans without a client", ledger.unheard);
  context.report({{"dropped", ledger.dropped},
                  {"stalled", ledger.stalled},
                  {"damaged", ledger.damaged + ledger.readings_damaged},
                  {"restarted", ledger.restarted},
                  {"lost", ledger.readings_lost}});
  context.print(fmt::format("emulated {} scans and {} encoder readings, with {} faults", scans_, readings_,
                            ledger.faults()));
  emulator_.reset();
}

void register_emulate(Registrar& registrar) { registrar.stage<EmulateStage>(); }

}  // namespace crisp::emulate
