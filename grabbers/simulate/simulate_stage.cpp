// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/simulate_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include <crisp/error.hpp>

#include "grabbers/simulate/inject_stage.hpp"
#include "grabbers/simulate/real_devices.hpp"
#include "grabbers/simulate/truth_file.hpp"
#include "pipeline/files/quantity.hpp"

namespace crisp::simulate {
namespace {

double seconds(const std::string& what, const std::string& text) {
  const auto parsed = files::parse_quantity(text, "s");
  if (const auto* complaint = std::get_if<files::Complaint>(&parsed)) {
    throw Error("'" + what + "' is not understood: " + complaint->text,
                "write it as laser2@3s+1s (a silence) or laser1@5s (a restart)");
  }
  return std::get<double>(parsed);
}

/// "laser2@3s+1s": device, begin, duration. Without a "+" the duration is missing.
Silence parse_silence(const std::string& text) {
  const auto at = text.find('@');
  const auto plus = text.find('+', at);
  const std::string begin = at == std::string::npos ? "" : text.substr(at + 1, plus - at - 1);
  const std::string duration = plus == std::string::npos ? "" : text.substr(plus + 1);
  return {.device = text.substr(0, at), .begin = seconds(text, begin), .duration = seconds(text, duration)};
}

Restart parse_restart(const std::string& text) {
  const auto at = text.find('@');
  const std::string time = at == std::string::npos ? "" : text.substr(at + 1);
  return {.device = text.substr(0, at), .time = seconds(text, time)};
}

}  // namespace

RecordingSettings SimulateStage::settings(const RunSettings& run) const {
  RecordingSettings result = settings_;
  result.start_ns = std::llround(1e9 * start_);
  result.scanner.rig = run.rig;
  result.scanner.seed = seed_.value_or(run.seed);
  for (const auto& text : silences_) result.faults.silences.push_back(parse_silence(text));
  for (const auto& text : restarts_) result.faults.restarts.push_back(parse_restart(text));
  return result;
}

void SimulateStage::check(const RunSettings& run) const {
  RecordingSettings planned = settings(run);
  const TermRegistry& terms = known_terms(run);
  const auto catalogue = recording_catalogue(terms);
  std::vector<Effect> effects;
  check_all([&] { planned.scanner.truth = hidden_.drawn(run, planned.scanner.seed); },
            [&] { effects = effects_of_real_devices(realism_.devices, run.rig, catalogue); },
            [&] {
              std::ranges::move(read_effects(hidden_.effects, run.rig, catalogue),
                                std::back_inserter(effects));
            },
            [&] { make_motion(planned.scanner.motion, planned.scanner.duration, planned.scanner.seed); },
            [&] { planned.scanner.field.beams(); }, [&] { kinds_.apply(planned.scanner); });
  add_terms(planned.scanner.truth, apply_device_effects(std::move(effects), planned), terms);
  draw_devices(planned);
}

void SimulateStage::process(const Inputs&, Outputs& out, Context& context) {
  const TermRegistry& terms = known_terms(context.run());
  simulated_ = settings(context.run());
  kinds_.apply(simulated_.scanner);
  simulated_.scanner.truth = hidden_.load(context, simulated_.scanner.seed);
  const auto catalogue = recording_catalogue(terms);
  auto effects = realism_.load(catalogue, context);
  std::ranges::move(read_effects(hidden_.effects, context.rig(), catalogue), std::back_inserter(effects));
  add_terms(simulated_.scanner.truth, apply_device_effects(std::move(effects), simulated_), terms);
  const Scene surroundings = scene_.load(context);
  simulated_scene_ = surroundings.name;

  RecordingSimulator simulator(simulated_, surroundings, terms);
  truth_ = simulator.truth();
  if (!capture_file_.empty()) {
    capture_ = std::make_unique<RecordedCapture>(capture_file_, simulated_, truth_, wire_faults_);
  }
  std::size_t scans = 0;
  std::size_t readings = 0;
  while (const auto event = simulator.next()) {
    if (context.interrupted()) return;
    if (capture_) capture_->write(*event);
    if (const auto* telegram = std::get_if<LaserTelegram>(&*event)) {
      out.give(to_scan(*telegram));
      if (++scans % 64 == 0) context.progress(simulator.progress(), "simulating");
    } else {
      out.give(std::get<PlateReading>(*event));
      ++readings;
    }
  }
  context.report({{"scene", simulated_scene_},
                  {"seed", simulated_.scanner.seed},
                  {"scans", scans},
                  {"readings", readings}});
  context.print(fmt::format("simulated {:g} s in the {} (seed {}): {} scans, {} encoder readings",
                            simulated_.scanner.duration, simulated_scene_, simulated_.scanner.seed, scans,
                            readings));
}

void SimulateStage::finish(Outputs&, Context& context) {
  if (capture_) {
    capture_->close();
    context.wrote(capture_file_);
    context.count("injected frame losses", capture_->faults().lost);
    context.count("injected frame repetitions", capture_->faults().repeated);
    context.count("injected frame damages", capture_->faults().damaged);
    capture_.reset();
  }
  if (!truth_file_.empty()) {
    write_truth(truth_file_, truth_, simulated_, simulated_scene_);
    context.wrote(truth_file_);
  }
}

void register_simulate(Registrar& registrar) {
  registrar.stage<SimulateStage>();
  registrar.stage<InjectStage>();
}

}  // namespace crisp::simulate
