// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/faults.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace independent {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void inject_mount(Draws& draws, Setup& setup) {
  const double coarse[] = {45, 90, 180, -45, -90};
  const double fine =
      draws.uniform("mount_fault_fine", 1, 5) * (draws.chance("mount_fault_negative", 0.5) ? -1 : 1);
  const double drawn =
      draws.chance("mount_fault_is_fine", 0.5) ? fine : coarse[draws.integer("mount_fault_coarse", 0, 4)];
  const double error = draws.uniform("mount_fault", drawn, drawn);
  const bool affects_all = draws.chance("mount_fault_of_all", 0.4);
  const auto only = static_cast<std::size_t>(
      draws.integer("mount_fault_laser", 0, static_cast<int>(setup.lasers.size()) - 1));
  for (std::size_t i = 0; i < setup.lasers.size(); ++i) {
    if (affects_all || i == only) setup.lasers[i].rig_mount += error * kDegree;
  }
  setup.fault_detail =
      "mount of " + (affects_all ? "all" : setup.lasers[only].name) + " wrong by " + number(error) + " deg";
}

void inject_direction(Draws&, Setup& setup) {
  setup.plate.rig_direction = setup.plate.is_clockwise ? "counter_clockwise" : "clockwise";
  setup.fault_detail =
      "encoder counts " + std::string(setup.plate.is_clockwise ? "clockwise" : "counter_clockwise");
}

void inject_counts(Draws& draws, Setup& setup) {
  const double percent =
      draws.uniform("counts_fault_percent", 1, 5) * (draws.chance("counts_fault_negative", 0.5) ? -1 : 1);
  const double factors[] = {2, 4, 0.5, 0.25, 1 + percent / 100, 1 + percent / 100};
  const double factor = factors[draws.integer("counts_fault", 0, 5)];
  setup.plate.rig_counts = std::max(2.0, std::round(factor * setup.plate.counts));
  setup.fault_detail = "counts_per_revolution times " + number(setup.plate.rig_counts / setup.plate.counts);
}

/// Whether an exchange of two addresses contradicts the nominal values, λ counted from the rig's first laser.
bool is_distinguishable(const std::vector<LaserSetup>& lasers, std::size_t a, std::size_t b) {
  std::vector<const LaserSetup*> devices;  // that the rig's lasers get, in the rig's order
  for (const auto& laser : lasers) devices.push_back(&laser);
  std::swap(devices[a], devices[b]);
  for (std::size_t i = 0; i < lasers.size(); ++i) {
    const Geometry &device = devices[i]->truth, &nominal = lasers[i].nominal;
    const double lambda = device.lambda - devices[0]->truth.lambda - nominal.lambda;
    if (std::abs(wrapped(lambda)) > 30 * kDegree || std::abs(device.tau - nominal.tau) > 0.08) return true;
    if (std::abs(wrapped(device.alpha - nominal.alpha)) > 30 * kDegree) return true;
    if (std::abs(wrapped(devices[i]->mount - lasers[i].mount)) > 30 * kDegree) return true;
  }
  return false;
}

bool inject_swapped(Draws& draws, Setup& setup) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < setup.lasers.size(); ++a) {
    for (std::size_t b = a + 1; b < setup.lasers.size(); ++b) {
      if (is_distinguishable(setup.lasers, a, b)) pairs.emplace_back(a, b);
    }
  }
  if (pairs.empty()) return false;
  const auto [a, b] =
      pairs[static_cast<std::size_t>(draws.integer("swapped_pair", 0, static_cast<int>(pairs.size()) - 1))];
  std::swap(setup.lasers[a].rig_address, setup.lasers[b].rig_address);
  std::swap(setup.lasers[a].rig_port, setup.lasers[b].rig_port);
  setup.fault_detail = "addresses of " + setup.lasers[a].name + " and " + setup.lasers[b].name + " exchanged";
  return true;
}

bool inject_missing(Draws& draws, Setup& setup) {
  if (setup.lasers.size() < 2) return false;
  auto& laser = setup.lasers[static_cast<std::size_t>(
      draws.integer("missing_laser", 0, static_cast<int>(setup.lasers.size()) - 1))];
  laser.is_silent = true;
  setup.fault_detail = laser.name + " sends nothing";
  return true;
}

void inject_slip(Draws& draws, Setup& setup) {
  auto random = draws.stream("slips");
  std::uniform_real_distribution<> size(1, 10), share(0.15, 0.85), sign(-1, 1);
  const auto jump = [&] { return std::copysign(size(random), sign(random)) * kDegree; };
  if (draws.chance("slips_once", 0.5)) {
    setup.plate.slips.emplace_back(share(random) * setup.duration, jump());
  } else {
    std::exponential_distribution<> wait(draws.log_uniform("slip_rate", 0.1, 0.6));
    for (double t = 0.5 + wait(random); t < setup.duration - 0.5; t += wait(random))
      setup.plate.slips.emplace_back(t, jump());
    if (setup.plate.slips.empty()) setup.plate.slips.emplace_back(0.5 * setup.duration, jump());
  }
  setup.fault_detail = "encoder slips";
  for (const auto& [time, angle] : setup.plate.slips) {
    setup.fault_detail += ", " + number(angle / kDegree) + " deg at " + number(time) + " s";
  }
}

}  // namespace

void draw_fault(Draws& draws, Setup& setup) {
  setup.fault = draws.choice("fault", {{"none", 80},
                                       {"mount", 5},
                                       {"direction", 3},
                                       {"counts", 3},
                                       {"swapped", 3},
                                       {"missing", 3},
                                       {"slip", 3}});
  bool is_possible = true;
  if (setup.fault == "mount") inject_mount(draws, setup);
  if (setup.fault == "direction") inject_direction(draws, setup);
  if (setup.fault == "counts") inject_counts(draws, setup);
  if (setup.fault == "swapped") is_possible = inject_swapped(draws, setup);
  if (setup.fault == "missing") is_possible = inject_missing(draws, setup);
  if (setup.fault == "slip") inject_slip(draws, setup);
  if (is_possible) return;
  if (draws.is_fixed("fault")) {
    throw std::runtime_error("this rig cannot have fault=" + setup.fault +
                             "; use another seed, or more lasers");
  }
  setup.fault = "none";
}

}  // namespace independent
