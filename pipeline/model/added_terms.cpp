// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/added_terms.hpp"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>

#include "pipeline/model/traced_runs.hpp"

namespace crisp {
namespace {

constexpr std::size_t kWidth = Jet::DIMENSION;

/// The quantities of a beam that a phase sets: see the table at Beam.
template <class T>
boost::container::static_vector<T*, 6> set_by(Phase phase, Beam<T>& beam) {
  switch (phase) {
    case Phase::kTime:
      return {&beam.time};
    case Phase::kPlate:
      return {&beam.plate_angle};
    case Phase::kMirror:
      return {&beam.mirror_angle};
    case Phase::kBeam:
    case Phase::kMount:
    case Phase::kBase:
      return {&beam.origin.x(),    &beam.origin.y(),    &beam.origin.z(),
              &beam.direction.x(), &beam.direction.y(), &beam.direction.z()};
    case Phase::kRange:
      return {&beam.range};
  }
  return {};
}

/// Beams of one laser after each phase of its chain, and what a change of a quantity then moves their ends
/// by.
class TracedBeams {
 public:
  using Slopes = std::array<double, 6>;  ///< normal · ∂x/∂q, for each quantity q that a phase sets

  /// @param phases  those that are needed, ascending
  TracedBeams(const LaserChain& chain, const std::vector<double>& values, const Measurements& beams,
              std::size_t begin, std::size_t end, const PlateTrajectory& plate, std::span<const Phase> phases)
      : chain_(chain), plate_(plate), bare_(end - begin) {
    fill<double>(beams, begin, bare_);
    auto traced = bare_;
    trace<double>(chain, values, traced, plate, known_, [&](Phase phase, std::span<Beam<double>> block) {
      if (std::ranges::find(phases, phase) != phases.end())
        after_[static_cast<std::size_t>(phase)].assign(block.begin(), block.end());
    });
  }

  bool is_known(std::size_t beam) const { return known_[beam]; }
  const Beam<double>& after(Phase phase, std::size_t beam) const {
    return after_[static_cast<std::size_t>(phase)][beam];
  }
  const Slopes& slopes(Phase phase, std::size_t beam) const {
    return slopes_[static_cast<std::size_t>(phase)][beam];
  }

  /// Differentiates the ends with respect to what some phases set, at most eight quantities.
  void differentiate(std::span<const Phase> phases, const std::vector<double>& values,
                     const Eigen::Vector3d& normal) {
    std::vector<Beam<Jet>> block(bare_.size());
    for (std::size_t i = 0; i < block.size(); ++i) block[i] = with_readings_of(bare_[i]);
    std::array<Eigen::Index, kPhases> first{};
    Eigen::Index next = 0;
    const std::vector<Jet> parameters(values.begin(), values.end());
    trace<Jet>(chain_, parameters, block, plate_, known_, [&](Phase phase, std::span<Beam<Jet>> all) {
      if (std::ranges::find(phases, phase) == phases.end()) return;
      first[static_cast<std::size_t>(phase)] = next;
      const auto seeds = static_cast<Eigen::Index>(set_by(phase, all.front()).size());
      for (Beam<Jet>& beam : all) {
        Eigen::Index seed = next;
        for (Jet* quantity : set_by(phase, beam)) quantity->v[seed++] += 1;
      }
      next += seeds;
    });
    for (const Phase phase : phases) {
      auto& slopes = slopes_[static_cast<std::size_t>(phase)];
      slopes.resize(block.size());
      for (std::size_t i = 0; i < block.size(); ++i) {
        const Vector3<Jet> end = block[i].point();
        for (std::size_t k = 0; k < set_by(phase, block[i]).size(); ++k) {
          const Eigen::Index seed = first[static_cast<std::size_t>(phase)] + static_cast<Eigen::Index>(k);
          slopes[i][k] =
              normal.x() * end.x().v[seed] + normal.y() * end.y().v[seed] + normal.z() * end.z().v[seed];
        }
      }
    }
  }

  static Beam<Jet> with_readings_of(const Beam<double>& beam) {
    Beam<Jet> jets;
    jets.measured_range = beam.measured_range;
    jets.measured_mirror = beam.measured_mirror;
    jets.hub_time = beam.hub_time;
    jets.remission = beam.remission;
    jets.cos_incidence = beam.cos_incidence;
    jets.number = beam.number;
    return jets;
  }

 private:
  const LaserChain& chain_;
  const PlateTrajectory& plate_;
  std::vector<Beam<double>> bare_;
  std::array<bool, kTracedBlock> known_{};
  std::array<std::vector<Beam<double>>, kPhases> after_;
  std::array<std::vector<Slopes>, kPhases> slopes_;
};

Beam<Jet> as_jets(const Beam<double>& beam) {
  Beam<Jet> jets = TracedBeams::with_readings_of(beam);
  jets.time = Jet(beam.time);
  jets.encoder_angle = Jet(beam.encoder_angle);
  jets.plate_rate = Jet(beam.plate_rate);
  jets.plate_angle = Jet(beam.plate_angle);
  jets.mirror_angle = Jet(beam.mirror_angle);
  jets.origin = beam.origin.cast<Jet>();
  jets.direction = beam.direction.cast<Jet>();
  jets.range = Jet(beam.range);
  return jets;
}

/// How far the derivatives of what the phase sets move the beam's end along the normal. Sets them to 0, for
/// the phase's next pass.
Eigen::Matrix<double, kWidth, 1> take_derivatives(Phase phase, const TracedBeams::Slopes& slopes,
                                                  Beam<Jet>& beam) {
  Eigen::Matrix<double, kWidth, 1> moved = Eigen::Matrix<double, kWidth, 1>::Zero();
  const auto changed = set_by(phase, beam);
  for (std::size_t q = 0; q < changed.size(); ++q) {
    moved += slopes[q] * changed[q]->v;
    changed[q]->v.setZero();
  }
  return moved;
}

/// The phases of passes that are in the order of phases, each once.
template <class Passes>
std::vector<Phase> phases_of(const Passes& passes) {
  std::vector<Phase> phases;
  for (const auto& pass : passes) {
    if (phases.empty() || phases.back() != pass.phase) phases.push_back(pass.phase);
  }
  return phases;
}

std::size_t quantities(Phase phase) {
  Beam<double> any;
  return set_by(phase, any).size();
}

/// Groups phases that set at most eight quantities together.
std::vector<std::vector<Phase>> grouped(std::span<const Phase> phases) {
  std::vector<std::vector<Phase>> groups;
  std::size_t taken = kWidth;
  for (const Phase phase : phases) {
    if (taken + quantities(phase) > kWidth) {
      groups.emplace_back();
      taken = 0;
    }
    groups.back().push_back(phase);
    taken += quantities(phase);
  }
  return groups;
}

}  // namespace

AddedTerms::AddedTerms(const SensorModel& model, const std::vector<std::vector<AddedTerm>>& of_laser) {
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    chains_.push_back(model.chain(laser));
    values_.push_back(chain_values(chains_.back(), model.values()));
    passes_.push_back(laser < of_laser.size() ? passes_of(of_laser[laser]) : std::vector<Pass>{});
  }
}

std::vector<AddedTerms::Pass> AddedTerms::passes_of(const std::vector<AddedTerm>& terms) {
  std::vector<Pass> passes;
  for (const AddedTerm& added : terms) {
    const Phase phase = added.term->info().phase;
    const std::vector<Jet> neutral(added.values.begin(), added.values.end());
    for (std::size_t k = 0; k < added.parameters.size(); ++k) {
      const auto of_phase = std::ranges::find(passes.rbegin(), passes.rend(), phase, &Pass::phase);
      const bool has_room = of_phase != passes.rend() && of_phase->columns.size() < kWidth;
      Pass& pass =
          has_room ? *of_phase : passes.emplace_back(Pass{.phase = phase, .terms = {}, .columns = {}});
      if (k == 0 || pass.columns.empty()) pass.terms.push_back({.term = added.term, .parameters = neutral});
      pass.terms.back().parameters[added.parameters[k]].v[static_cast<Eigen::Index>(pass.columns.size())] = 1;
      pass.columns.push_back(added.columns[k]);
    }
  }
  std::ranges::stable_sort(passes, {}, &Pass::phase);
  return passes;
}

void AddedTerms::fill_rows(const Measurements& beams, const PlateTrajectory& plate,
                           const Eigen::Vector3d& normal, std::size_t stride, std::span<double> rows) const {
  for (std::size_t begin = 0; begin < beams.size();) {
    chain_of(chains_, beams, begin);
    const std::size_t laser = beams.laser[begin];
    const std::size_t end = run_end(beams, begin, kTracedBlock);
    const std::vector<Phase> phases = phases_of(passes_[laser]);
    TracedBeams traced(chains_[laser], values_[laser], beams, begin, end, plate, phases);
    for (const auto& group : grouped(phases)) traced.differentiate(group, values_[laser], normal);

    std::vector<Beam<Jet>> block(end - begin);
    Phase of_block{};
    bool is_filled = false;
    for (const Pass& pass : passes_[laser]) {
      if (!is_filled || of_block != pass.phase) {
        for (std::size_t i = 0; i < block.size(); ++i) block[i] = as_jets(traced.after(pass.phase, i));
        of_block = pass.phase;
        is_filled = true;
      }
      for (const Seeded& seeded : pass.terms) seeded.term->apply(block, seeded.parameters);
      for (std::size_t i = 0; i < block.size(); ++i) {
        const auto moved = take_derivatives(pass.phase, traced.slopes(pass.phase, i), block[i]);
        if (!traced.is_known(i)) continue;
        for (std::size_t k = 0; k < pass.columns.size(); ++k)
          rows[(begin + i) * stride + pass.columns[k]] = moved[static_cast<Eigen::Index>(k)];
      }
    }
    begin = end;
  }
}

}  // namespace crisp
