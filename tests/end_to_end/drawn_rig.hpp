// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>

namespace crisp::test {

/// What a parameter was found as, against the truth of another simulator.
struct FoundParameter {
  std::string name;  ///< "front.tau"
  double error = 0;  ///< in SI
  double std_error = 0;
  bool free = false;

  /// Beyond 5 standard errors, and beyond 1 mm, 0.1° or 0.1 ms.
  bool is_wrong() const;
};

/// The effect that the simulator injected, in a form of its own.
struct InjectedEffect {
  std::string cause;  ///< as docs/effects.md calls it; "none", "shape"
  std::string form;
  std::string scope;  ///< of a laser, or "all"
  double rms = 0;     ///< [m] by which it changes ranges
};

/// A rig and its recording as tests/independent draws them from a seed, which shares nothing with crisp.
class DrawnRig {
 public:
  /// @param folder  for the capture, the rig's file and the truth
  /// @param fixed   draws that are fixed: "fault=mount", "duration=8"
  /// @throws std::runtime_error if it cannot be drawn
  DrawnRig(const std::filesystem::path& folder, std::uint64_t seed,
           const std::vector<std::string>& fixed = {});

  std::filesystem::path capture() const { return folder_ / "capture.pcap"; }
  std::filesystem::path rig() const { return folder_ / "rig.yaml"; }
  const std::string& fault() const { return fault_; }  ///< what is wrong in the rig's file; "none"
  const InjectedEffect& effect() const { return effect_; }
  const std::string& words() const {
    return words_;
  }  ///< "office, varied, 12 s; lms1xx at 45, lms5xx at 90 deg"

  /// What is known before the recording, as options of study.bound: "duration=8s".
  const std::vector<std::string>& plan() const { return plan_; }

  /// All parameters but the gauge, of the lasers that sent anything. (λ, −τ, α + 180°) is what (λ + 180°, τ,
  /// α) is, and all lasers at once turn with the frame.
  std::vector<FoundParameter> compare(const Calibration& found) const;

 private:
  struct Laser {
    std::string name;
    double lambda = 0, tau = 0, alpha = 0;  ///< [rad, m, rad]
    double eta = 0;                         ///< [s] as crisp counts it, with the delays that really occurred
    int scans = 0;
  };
  std::vector<FoundParameter> compare_turned(const Calibration& calibration, double turn) const;

  std::filesystem::path folder_;
  std::string fault_;
  InjectedEffect effect_;
  std::string words_;
  std::vector<std::string> plan_;
  std::vector<Laser> lasers_;
};

}  // namespace crisp::test
