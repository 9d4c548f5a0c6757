// SPDX-License-Identifier: BSD-3-Clause
#include "tests/end_to_end/drawn_rig.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "pipeline/data/degree.hpp"

namespace crisp::test {
namespace {

using namespace crisp::data;

constexpr double kPi = std::numbers::pi;

double wrapped(double angle) { return std::remainder(angle, 2 * kPi); }

/// How far a laser's pose is off, in metres at 1 m about.
double size_of(const std::vector<FoundParameter>& pose) {
  double sum = 0;
  for (const FoundParameter& parameter : pose) sum += std::abs(parameter.error);
  return sum;
}

FoundParameter found(const std::string& name, const Parameter& parameter, double error) {
  return {.name = name, .error = error, .std_error = parameter.std_error, .free = parameter.free};
}

/// Of the scenes and motions that study.bound has, the nearest ones: it has no tunnel.
std::vector<std::string> plan_of(const YAML::Node& truth) {
  const auto scene = truth["scene"].as<std::string>();
  const auto motion = truth["motion"].as<std::string>();
  const auto duration = truth["duration"].as<double>();
  const double rate = truth["turns"].as<double>() / duration;
  std::string lasers;
  for (const auto& entry : truth["lasers"]) {
    const YAML::Node& laser = entry.second;
    const auto kind = laser["kind"].as<std::string>();
    const auto step = laser["step_deg"].as<double>();
    const auto [first, last] = kind == "lms1xx"   ? std::pair(-45.0, 225.0)
                               : kind == "lms5xx" ? std::pair(-5.0, 185.0)
                                                  : std::pair(0.0, 360 - step);
    lasers +=
        fmt::format("{}{}: {{first_angle: {}deg, last_angle: {}deg, step: {}deg, mirror_frequency: {}Hz}}",
                    lasers.empty() ? "" : ", ", entry.first.as<std::string>(), first, last, step,
                    laser["rate"].as<double>());
  }
  const bool is_steady = motion == "constant" || motion == "ripple";
  const double slowest = is_steady ? truth["rates"][0].as<double>() : 0.6 * rate;
  const double fastest = is_steady ? truth["rates"][1].as<double>() : 1.6 * rate;
  constexpr double kLongest = 20;  // s: observability does not depend on more
  return {"scene=" + (scene == "tunnel" ? "hall" : scene),
          "motion.kind=" + (motion == "varied" || motion == "ripple" ? "varying" : motion),
          fmt::format("motion.min_rate={}Hz", slowest),
          fmt::format("motion.max_rate={}Hz", fastest),
          fmt::format("duration={}s", std::min(duration, kLongest)),
          "lasers.kinds={" + lasers + "}"};
}

}  // namespace

bool FoundParameter::is_wrong() const {
  constexpr double kErrors = 5;
  const double least = name.ends_with(".tau") ? 1e-3 : name.ends_with(".eta") ? 1e-4 : 0.1 * kDegree;
  return free && std::abs(error) > std::max(least, kErrors * std_error);
}

DrawnRig::DrawnRig(const std::filesystem::path& folder, std::uint64_t seed,
                   const std::vector<std::string>& fixed)
    : folder_(folder) {
  std::filesystem::create_directories(folder);
  std::string command = fmt::format(R"("{}" {} "{}")", CRISP_INDEPENDENT_SCANNER, seed, folder.string());
  for (const auto& draw : fixed) command += " \"" + draw + "\"";
  if (std::system((command + " > /dev/null").c_str()) != 0) throw std::runtime_error(command + " failed");
  const YAML::Node truth = YAML::LoadFile(folder / "truth.yaml");
  fault_ = truth["fault"].as<std::string>();
  const YAML::Node& effect = truth["effect"];
  effect_ = {.cause = effect["cause"].as<std::string>(),
             .form = effect["form"].as<std::string>(),
             .scope = effect["scope"].as<std::string>(),
             .rms = effect["rms"].as<double>()};
  words_ = fmt::format("{}, {}, {:.0f} s;", truth["scene"].as<std::string>(),
                       truth["motion"].as<std::string>(), truth["duration"].as<double>());
  plan_ = plan_of(truth);
  for (const auto& entry : truth["lasers"]) {
    const YAML::Node& laser = entry.second;
    const auto number = [&](const char* key) { return laser[key].as<double>(); };
    // crisp counts from −45°, whatever a unit's first beam; what the hub saw has the delays that occurred.
    const double eta = number("eta_from_minus_45") + number("eta_sample") - number("eta");
    lasers_.push_back({.name = laser["name_in_rig"].as<std::string>(),
                       .lambda = number("lambda"),
                       .tau = number("tau"),
                       .alpha = number("alpha"),
                       .eta = eta,
                       .scans = laser["scans"].as<int>()});
    words_ += fmt::format(" {} at {:.0f}", laser["kind"].as<std::string>(), number("mount") / kDegree);
  }
}

std::vector<FoundParameter> DrawnRig::compare(const Calibration& found) const {
  const auto as_it_is = compare_turned(found, 0);
  const auto turned = compare_turned(found, kPi);
  return size_of(as_it_is) <= size_of(turned) ? as_it_is : turned;
}

std::vector<FoundParameter> DrawnRig::compare_turned(const Calibration& calibration, double turn) const {
  std::vector<FoundParameter> all;
  std::optional<double> frame;  // in which the first laser that sent anything is where the truth has it
  for (const Laser& laser : lasers_) {
    const auto own = std::ranges::find(calibration.lasers, laser.name, &LaserCalibration::name);
    if (own == calibration.lasers.end() || laser.scans == 0) continue;
    if (!frame) frame = &laser == &lasers_.front() ? turn : own->lambda.value - laser.lambda + turn;
    std::vector<FoundParameter> nearest;
    for (const bool other_form : {false, true}) {
      const double half = other_form ? kPi : 0;
      const double tau = other_form ? -own->tau.value : own->tau.value;
      const std::vector<FoundParameter> pose = {
          found(laser.name + ".lambda", own->lambda,
                wrapped(own->lambda.value + half - laser.lambda - *frame)),
          found(laser.name + ".tau", own->tau, tau - laser.tau),
          found(laser.name + ".alpha", own->alpha, wrapped(own->alpha.value + half - laser.alpha))};
      if (nearest.empty() || size_of(pose) < size_of(nearest)) nearest = pose;
    }
    all.insert(all.end(), nearest.begin(), nearest.end());
    all.push_back(found(laser.name + ".eta", own->eta, own->eta.value - laser.eta));
  }
  return all;
}

}  // namespace crisp::test
