// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/chain_jacobian.hpp"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <limits>
#include <utility>

namespace crisp::model {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kSeeded = kNone;  // in a group: the seeded parameters, which are of no phase

/// The quantities of a beam that a phase sets: see the table at Beam.
template <class T>
[[gnu::always_inline]] inline boost::container::static_vector<T*, 6> set_by(Phase phase, Beam<T>& beam) {
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

std::size_t quantities(Phase phase) {
  Beam<double> any;
  return set_by(phase, any).size();
}

Beam<Jet> with_readings_of(const Beam<double>& beam) {
  Beam<Jet> jets;
  jets.measured_range = beam.measured_range;
  jets.measured_mirror = beam.measured_mirror;
  jets.hub_time = beam.hub_time;
  jets.remission = beam.remission;
  jets.cos_incidence = beam.cos_incidence;
  jets.number = beam.number;
  return jets;
}

Beam<Jet> as_jets(const Beam<double>& beam) {
  Beam<Jet> jets = with_readings_of(beam);
  jets.time = Jet(beam.time);
  jets.encoder_angle = Jet(beam.encoder_angle);
  jets.plate_rate = Jet(beam.plate_rate);
  jets.plate_direction = Jet(beam.plate_direction);
  jets.plate_angle = Jet(beam.plate_angle);
  jets.mirror_angle = Jet(beam.mirror_angle);
  jets.origin = beam.origin.cast<Jet>();
  jets.direction = beam.direction.cast<Jet>();
  jets.range = Jet(beam.range);
  return jets;
}

/// Whether the ends' slopes at the end of a phase follow from the ends themselves.
bool has_closed_form(const LaserChain& chain, Phase phase) {
  const bool has_range_terms = !chain.phases[static_cast<std::size_t>(Phase::kRange)].empty();
  return phase == Phase::kRange || (phase == Phase::kBase && !has_range_terms);
}

/// Groups what takes at most eight seeds.
///
/// @param seeds  of each item
std::vector<std::vector<std::size_t>> grouped(const std::vector<std::pair<std::size_t, std::size_t>>& seeds) {
  constexpr std::size_t kWidth = Jet::DIMENSION;
  std::vector<std::vector<std::size_t>> groups;
  std::size_t taken = kWidth;
  for (const auto& [item, count] : seeds) {
    if (taken + count > kWidth) {
      groups.emplace_back();
      taken = 0;
    }
    groups.back().push_back(item);
    taken += count;
  }
  return groups;
}

}  // namespace

template <int kRows>
ChainJacobian<kRows>::ChainJacobian(const LaserChain& chain, std::vector<double> values,
                                    std::vector<SeededSlot> seeded, const std::vector<VariedTerm>& terms)
    : chain_(chain), values_(std::move(values)), seeded_(std::move(seeded)) {
  add_stops(terms);
  for (const VariedTerm& term : terms) add_passes(term);
  std::ranges::stable_sort(passes_, {}, &Pass::stop);
  add_groups();
}

/// Stops at the terms, and at those that follow them in the same phase: through these their changes go.
template <int kRows>
void ChainJacobian<kRows>::add_stops(const std::vector<VariedTerm>& terms) {
  for (std::size_t p = 0; p < kPhases; ++p) {
    const auto phase = static_cast<Phase>(p);
    std::size_t first = kNone;
    for (const VariedTerm& varied : terms) {
      if (varied.place.phase == phase) first = std::min(first, varied.place.term);
    }
    if (first == kNone) continue;
    for (std::size_t k = first; k <= terms_of(phase).size(); ++k)
      stops_.push_back({.place = {phase, k}, .beams = {}, .slopes = {}});
  }
}

template <int kRows>
std::size_t ChainJacobian<kRows>::stop_at(ChainPlace place) const {
  return static_cast<std::size_t>(std::ranges::find(stops_, place, &Stop::place) - stops_.begin());
}

template <int kRows>
void ChainJacobian<kRows>::add_passes(const VariedTerm& varied) {
  const std::size_t stop = stop_at(varied.place);
  const std::vector<Jet> constant(varied.values.begin(), varied.values.end());
  for (std::size_t k = 0; k < varied.parameters.size(); ++k) {
    const auto of_stop = std::ranges::find(passes_.rbegin(), passes_.rend(), stop, &Pass::stop);
    const bool has_room = of_stop != passes_.rend() && of_stop->columns.size() < kWidth;
    Pass& pass = has_room ? *of_stop : passes_.emplace_back(Pass{.stop = stop, .terms = {}, .columns = {}});
    if (k == 0 || pass.columns.empty()) pass.terms.push_back({.term = varied.term, .parameters = constant});
    pass.terms.back().parameters[varied.parameters[k]].v[static_cast<Eigen::Index>(pass.columns.size())] = 1;
    pass.columns.push_back(varied.columns[k]);
  }
}

template <int kRows>
void ChainJacobian<kRows>::add_groups() {
  std::vector<std::pair<std::size_t, std::size_t>> seeds;
  if (!seeded_.empty()) seeds.emplace_back(kSeeded, seeded_.size());
  for (std::size_t p = 0; p < kPhases; ++p) {
    const auto phase = static_cast<Phase>(p);
    const bool is_needed = std::ranges::any_of(stops_, [&](const Stop& s) { return s.place.phase == phase; });
    if (is_needed && !has_closed_form(chain_, phase)) seeds.emplace_back(p, quantities(phase));
  }
  // Those of few seeds first: they fill up the first pass.
  std::ranges::stable_sort(seeds, {}, &std::pair<std::size_t, std::size_t>::second);
  groups_ = grouped(seeds);
}

template <int kRows>
void ChainJacobian<kRows>::trace_run(const Measurements& beams, std::size_t begin, std::size_t end,
                                     const PlateTrajectory& plate, const Directions& directions) {
  readings_.assign(end - begin, {});
  fill<double>(beams, begin, readings_);
  ends_ = readings_;
  trace<double>(chain_, values_, ends_, plate, known_, [&](ChainPlace place, std::span<Beam<double>> run) {
    const std::size_t stop = stop_at(place);
    if (stop < stops_.size()) stops_[stop].beams.assign(run.begin(), run.end());
  });
  seeded_slopes_.resize(readings_.size());
  for (const auto& group : groups_) differentiate_group(group, plate, directions);
  differentiate_ends(directions);
  for (std::size_t s = stops_.size(); s-- > 0;) {
    Stop& stop = stops_[s];
    const bool is_end = stop.place.term == terms_of(stop.place.phase).size();
    if (is_end)
      stop.slopes = end_slopes(stop.place.phase);
    else
      carry_back(stops_[s + 1], stop);
  }
  filled_ = kNone;
}

/// Slopes at the ends of some phases, and those of the seeded parameters.
template <int kRows>
void ChainJacobian<kRows>::differentiate_group(const std::vector<std::size_t>& group,
                                               const PlateTrajectory& plate, const Directions& directions) {
  jets_.clear();
  for (const Beam<double>& beam : readings_) jets_.push_back(with_readings_of(beam));
  std::vector<Jet> parameters(values_.begin(), values_.end());
  std::vector<Eigen::Index> first;  // seed of each item
  Eigen::Index next = 0;
  for (const std::size_t item : group) {
    first.push_back(next);
    if (item == kSeeded) {
      for (const SeededSlot& seeded : seeded_) parameters[seeded.slot].v[next++] = 1;
    } else {
      next += static_cast<Eigen::Index>(quantities(static_cast<Phase>(item)));
    }
  }
  trace<Jet>(chain_, parameters, jets_, plate, known_, [&](ChainPlace place, std::span<Beam<Jet>> run) {
    const auto item = std::ranges::find(group, static_cast<std::size_t>(place.phase));
    if (item == group.end() || place.term != terms_of(place.phase).size()) return;
    for (Beam<Jet>& beam : run) {
      Eigen::Index seed = first[static_cast<std::size_t>(item - group.begin())];
      for (Jet* quantity : set_by(place.phase, beam)) quantity->v[seed++] += 1;
    }
  });
  for (const std::size_t item : group) {
    if (item != kSeeded) end_slopes_[item].resize(jets_.size());
  }
  for (std::size_t i = 0; i < jets_.size(); ++i) {
    const Vector3<Jet> end = jets_[i].point();
    Eigen::Matrix<double, 3, kWidth> all;
    all << end.x().v.transpose(), end.y().v.transpose(), end.z().v.transpose();
    const Moved along = directions * all;
    for (std::size_t g = 0; g < group.size(); ++g) {
      if (group[g] == kSeeded)
        seeded_slopes_[i].leftCols(static_cast<Eigen::Index>(seeded_.size())) =
            along.middleCols(first[g], static_cast<Eigen::Index>(seeded_.size()));
      else
        for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(quantities(static_cast<Phase>(group[g]))); ++k)
          end_slopes_[group[g]][i].col(k) = along.col(first[g] + k);
    }
  }
}

/// The end's slopes by what the last phases set, in closed form.
template <int kRows>
void ChainJacobian<kRows>::differentiate_ends(const Directions& directions) {
  for (const Phase phase : {Phase::kBase, Phase::kRange}) {
    if (!has_closed_form(chain_, phase)) continue;
    auto& slopes = end_slopes(phase);
    slopes.resize(ends_.size());
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      if (phase == Phase::kRange)
        slopes[i].col(0) = directions * ends_[i].direction;
      else
        slopes[i] << directions, directions * ends_[i].range;
    }
  }
}

/// The slopes after a stop's term from those after the next term of its phase, through which they go.
template <int kRows>
void ChainJacobian<kRows>::carry_back(const Stop& next, Stop& stop) {
  const Phase phase = stop.place.phase;
  const auto& terms = terms_of(phase);
  stop.slopes = next.slopes;
  if (next.place.term == terms.size() || is_reading(phase)) return;
  const ChainTerm& term = terms[next.place.term];
  const auto count = static_cast<std::ptrdiff_t>(term.term->info().parameters.size());
  const auto first = values_.begin() + static_cast<std::ptrdiff_t>(term.first_slot);
  const std::vector<Jet> constant(first, first + count);
  jets_.clear();
  for (const Beam<double>& beam : next.beams) {
    jets_.push_back(as_jets(beam));
    Eigen::Index seed = 0;
    for (Jet* quantity : set_by(phase, jets_.back())) quantity->v[seed++] = 1;
  }
  term.term->apply(jets_, constant);
  for (std::size_t i = 0; i < jets_.size(); ++i) {
    Eigen::Matrix<double, kMostQuantities, kMostQuantities> through;
    Eigen::Index row = 0;
    for (const Jet* quantity : set_by(phase, jets_[i]))
      through.row(row++) = quantity->v.template head<kMostQuantities>().transpose();
    stop.slopes[i] = next.slopes[i] * through;
  }
}

template <int kRows>
void ChainJacobian<kRows>::apply(const Pass& pass) {
  if (filled_ != pass.stop) {
    jets_.clear();
    for (const Beam<double>& beam : stops_[pass.stop].beams) jets_.push_back(as_jets(beam));
    filled_ = pass.stop;
  }
  for (const Seeded& seeded : pass.terms) seeded.term->apply(jets_, seeded.parameters);
}

/// How the pass's parameters move the beam's end. Sets what its terms have changed back, for the stop's next
/// pass.
template <int kRows>
auto ChainJacobian<kRows>::take_derivatives(const Pass& pass, std::size_t beam) -> Moved {
  Stop& stop = stops_[pass.stop];
  const auto changed = set_by(stop.place.phase, jets_[beam]);
  const auto before = set_by(stop.place.phase, stop.beams[beam]);
  Moved moved = Moved::Zero();
  for (std::size_t q = 0; q < changed.size(); ++q) {
    moved += stop.slopes[beam].col(static_cast<Eigen::Index>(q)) * changed[q]->v.transpose();
    *changed[q] = Jet(*before[q]);
  }
  return moved;
}

template class ChainJacobian<1>;
template class ChainJacobian<3>;

}  // namespace crisp::model
