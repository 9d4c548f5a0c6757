// SPDX-License-Identifier: BSD-3-Clause
// Whole captures of valid telegrams, through the stages that a recording runs through first: whatever the
// devices, clocks, orders, gaps, resets and addresses, either an Error, or finite points, and what was left
// out is named.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <crisp/cloud.hpp>
#include <crisp/error.hpp>
#include <crisp/measurements.hpp>
#include <crisp/runner.hpp>
#include <crisp/term.hpp>

#include "grabbers/capture/register.hpp"
#include "plugins/assemble/register.hpp"
#include "plugins/clock/register.hpp"
#include "tests/fuzz/capture_script.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace crisp {
namespace {

using namespace crisp::assemble;
using namespace crisp::capture;
using namespace crisp::clock;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Takes what a run makes of a capture, and checks it.
struct Taker final : Stage {
  static inline std::array<std::size_t, 3> scans;  ///< of each laser that were placed

  static void describe(StageDescription<Taker>& d) {
    d.name("test.taker").summary("checks points").takes<Cloud>().takes<Measurements>();
  }
  void process(const Inputs& in, Outputs&, Context&) override {
    if (const auto* scan = in.find<Measurements>()) take(*scan);
    if (const auto* cloud = in.find<Cloud>()) take(*cloud);
  }

 private:
  static void take(const Measurements& scan) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      require(scan.laser[i] < scans.size(), "lasers are the rig's");
      require(std::isfinite(scan.time[i]), "times are finite");
    }
    if (scan.size() > 0) ++scans.at(scan.laser[0]);
  }
  static void take(const Cloud& cloud) {
    for (const auto& point : cloud) {
      const bool is_finite = std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
      require(is_finite && std::isfinite(point.time), "points are finite");
    }
  }
};

const Registrar& registrar() {
  static TermRegistry terms;
  static const Registrar all = [] {
    Registrar registrar;
    registrar.attach(terms, "term");
    register_capture(registrar);
    register_clock(registrar);
    register_assemble(registrar);
    registrar.stage<Taker>();
    return registrar;
  }();
  return all;
}

/// Whether a stage warns of something, or marks its results untrusted.
bool is_named(const std::vector<NodeResult>& results) {
  return std::ranges::any_of(results, [](const NodeResult& result) {
    return !result.report.warnings.empty() || !result.report.caveats.empty();
  });
}

/// Most of what each laser sent was placed, but for a few scans at the ends.
bool is_complete(const std::array<std::size_t, 3>& sent) {
  constexpr std::size_t kAtTheEnds = 4;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (10 * (Taker::scans[i] + kAtTheEnds) < 9 * sent[i]) return false;
  }
  return true;
}

void place(const CaptureScript& script, const std::string& file, const char* clock) {
  Taker::scans = {};
  RunSettings run;
  run.registrar = &registrar();
  try {
    Pipeline pipeline = build_pipeline({{.stage = "grabber.capture", .with = {{"file", OptionScalar(file)}}},
                                        {.stage = clock},
                                        {.stage = "assemble.deskew"},
                                        {.stage = "test.taker"}},
                                       run);
    const auto results = run_pipeline(pipeline, run);
    if (is_complete(script.scans()) || script.is_lossy()) return;
    if (is_named(results)) return;
    for (std::size_t i = 0; i < 3; ++i) {
      std::fprintf(stderr, "laser %zu sent %zu scans, of which %s placed %zu\n", i + 1, script.scans()[i],
                   clock, Taker::scans[i]);
    }
    require(false, "losses are named");
  } catch (const Error& error) {
    require(!error.message().empty(), "an error has a message");
  }
}

void place(std::span<const std::uint8_t> bytes) {
  CaptureScript script(bytes);
  const MemoryFile file(script.file());
  for (const char* clock : {"clock.convex_hull", "clock.online"}) place(script, file.path(), clock);
}

/// Regular data are placed.
bool place_four_seconds() {
  constexpr std::array<std::uint8_t, 3> kScript = {0, 0, 200};  // no edits; all devices send for 201 · 20 ms
  place(kScript);
  require(std::ranges::min(Taker::scans) == 100, "all scans of a regular capture are placed");
  return true;
}

}  // namespace
}  // namespace crisp

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace crisp;  // NOLINT(google-build-using-namespace)
  static const bool works = place_four_seconds();
  place({data, size});
  return works ? 0 : 1;
}
