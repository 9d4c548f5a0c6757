// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/sensor_model.hpp"

#include <algorithm>
#include <array>

#include "pipeline/data/error.hpp"
#include "pipeline/model/chain.hpp"

namespace crisp {
namespace {

constexpr std::size_t kPhases = static_cast<std::size_t>(Phase::kRange) + 1;
constexpr std::size_t kBaseParameters = 4;  // λ, τ, α, η
constexpr std::size_t kBlock = 64;          // beams that go through the chain together: they fit the cache

void check_parameters(const TermInfo& info, const TermParameters& given) {
  const bool same = std::equal(
      info.parameters.begin(), info.parameters.end(), given.parameters.begin(), given.parameters.end(),
      [](const auto& declared, const auto& have) { return declared.name == have.name; });
  if (same) return;
  std::string expected;
  for (const auto& parameter : info.parameters) expected += (expected.empty() ? "" : ", ") + parameter.name;
  throw Error("the calibration's parameters of " + info.name + " are not those of the term",
              "expected " + expected);
}

void add_terms(LaserChain& chain, const std::vector<TermParameters>& terms, std::size_t first_value,
               Scope scope, const TermRegistry& registry) {
  for (const auto& given : terms) {
    auto term = registry.get(given.term);
    check_parameters(term->info(), given);
    if (term->info().scope != scope) {
      throw Error("the term " + given.term + " stands under the wrong heading of the calibration",
                  scope == Scope::kLaser ? "put it under plate" : "put it under each laser");
    }
    const auto phase = static_cast<std::size_t>(term->info().phase);
    chain.phases[phase].push_back({std::move(term), chain.slots.size()});
    for (std::size_t i = 0; i < given.parameters.size(); ++i) chain.slots.push_back(first_value++);
    chain.bare = false;
  }
}

std::size_t count_parameters(const std::vector<TermParameters>& terms) {
  std::size_t n = 0;
  for (const auto& term : terms) n += term.parameters.size();
  return n;
}

/// Calls visit(parameter) for every parameter of a calibration, in the order of SensorModel::values().
template <class AnyCalibration, class Visit>
void for_each_parameter(AnyCalibration& calibration, Visit visit) {
  const auto all = [&](auto& terms) {
    for (auto& term : terms) {
      for (auto& parameter : term.parameters) visit(parameter);
    }
  };
  for (auto& laser : calibration.lasers) {
    for (auto* parameter : {&laser.lambda, &laser.tau, &laser.alpha, &laser.eta}) visit(*parameter);
    all(laser.terms);
  }
  all(calibration.plate_terms);
}

void check_input(const SensorModel& model, const Measurements& beams, const PlateTrajectory& plate) {
  if (beams.size() > 0 && !plate.empty() && beams.epoch_ns != plate.epoch_ns()) {
    throw Error("the measurements and the plate's trajectory count their time from different epochs");
  }
  const auto highest = std::max_element(beams.laser.begin(), beams.laser.end());
  if (highest != beams.laser.end() && *highest >= model.lasers()) {
    throw Error("the measurements name laser " + std::to_string(*highest + 1) +
                    ", but the calibration has only " + std::to_string(model.lasers()),
                "use the calibration of the rig that was recorded");
  }
}

/// End of the run of measurements of one laser that starts at `begin`, at most a block long.
std::size_t run_end(const Measurements& beams, std::size_t begin) {
  const std::size_t limit = std::min(beams.size(), begin + kBlock);
  std::size_t end = begin + 1;
  while (end < limit && beams.laser[end] == beams.laser[begin]) ++end;
  return end;
}

template <class T>
void fill(const Measurements& beams, std::size_t begin, std::span<Beam<T>> block) {
  for (std::size_t i = 0; i < block.size(); ++i) {
    block[i].measured_range = beams.range[begin + i];
    block[i].measured_mirror = beams.mirror_angle[begin + i];
    block[i].hub_time = beams.time[begin + i];
    block[i].remission = beams.remission[begin + i];
    block[i].number = beams.beam[begin + i];
  }
}

/// For each laser, the free parameters that it depends on and the slot of each in its chain.
struct FreeSlots {
  std::vector<std::vector<std::size_t>> columns;  ///< index into the list of free parameters
  std::vector<std::vector<std::size_t>> slots;    ///< index into the laser's slots
};

FreeSlots free_slots(const std::vector<LaserChain>& chains, const std::vector<std::size_t>& free) {
  FreeSlots result;
  for (const auto& chain : chains) {
    auto& columns = result.columns.emplace_back();
    auto& slots = result.slots.emplace_back();
    for (std::size_t f = 0; f < free.size(); ++f) {
      const auto slot = std::find(chain.slots.begin(), chain.slots.end(), free[f]);
      if (slot == chain.slots.end()) continue;
      columns.push_back(f);
      slots.push_back(static_cast<std::size_t>(slot - chain.slots.begin()));
    }
  }
  return result;
}

std::vector<double> chain_values(const LaserChain& chain, const Eigen::VectorXd& values) {
  std::vector<double> result;
  for (const auto slot : chain.slots) result.push_back(values[static_cast<Eigen::Index>(slot)]);
  return result;
}

Placed room_for(std::size_t measurements) {
  Placed result;
  result.points.resize(3, static_cast<Eigen::Index>(measurements));
  result.index.reserve(measurements);
  return result;
}

void shrink(Placed& placed) {
  placed.points.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(placed.index.size()));
}

/// Takes all measurements through their lasers' chains, in blocks, and visits those that the plate covers:
/// visit(index of the measurement, beam).
template <class T, class Parameters, class Visit>
void trace_all(const std::vector<LaserChain>& chains, Parameters parameters_of, const Measurements& beams,
               const PlateTrajectory& plate, Visit visit) {
  std::vector<std::vector<T>> parameters;
  for (std::size_t laser = 0; laser < chains.size(); ++laser) parameters.push_back(parameters_of(laser));
  PlateTrajectory::Cursor cursor(plate);
  std::vector<Beam<T>> block(kBlock);
  std::array<bool, kBlock> known{};
  for (std::size_t begin = 0; begin < beams.size();) {
    const std::size_t end = run_end(beams, begin);
    const std::span<Beam<T>> run(block.data(), end - begin);
    const auto laser = beams.laser[begin];
    fill(beams, begin, run);
    trace<T>(chains[laser], parameters[laser], run, cursor, known);
    for (std::size_t i = 0; i < run.size(); ++i) {
      if (known[i]) visit(begin + i, run[i]);
    }
    begin = end;
  }
}

}  // namespace

SensorModel::SensorModel(Calibration calibration, const TermRegistry& terms)
    : calibration_(std::move(calibration)) {
  std::vector<double> values;
  for_each_parameter(calibration_, [&](const Parameter& parameter) { values.push_back(parameter.value); });
  values_ = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));

  std::size_t first_plate = values.size() - count_parameters(calibration_.plate_terms);
  std::size_t next = 0;
  for (const auto& laser : calibration_.lasers) {
    for (const auto* parameter : {&laser.lambda, &laser.tau, &laser.alpha, &laser.eta}) {
      names_.push_back(laser.name + "." + parameter->name);
    }
    add_parameters(laser.name, laser.terms);

    LaserChain& chain = chains_.emplace_back();
    chain.phases.resize(kPhases);
    for (std::size_t i = 0; i < kBaseParameters; ++i) chain.slots.push_back(next + i);
    add_terms(chain, laser.terms, next + kBaseParameters, Scope::kLaser, terms);
    add_terms(chain, calibration_.plate_terms, first_plate, Scope::kPlate, terms);
    next += kBaseParameters + count_parameters(laser.terms);
  }
  add_parameters("plate", calibration_.plate_terms);
}

void SensorModel::add_parameters(const std::string& owner, const std::vector<TermParameters>& terms) {
  for (const auto& term : terms) {
    for (const auto& parameter : term.parameters)
      names_.push_back(owner + "." + term.term + "." + parameter.name);
  }
}

std::size_t SensorModel::index(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) throw Error("the sensor model has no parameter " + name);
  return static_cast<std::size_t>(found - names_.begin());
}

void SensorModel::set_values(const Eigen::VectorXd& values) {
  if (values.size() != values_.size()) throw Error("the sensor model was given a wrong number of values");
  values_ = values;
}

Calibration SensorModel::calibration() const {
  Calibration result = calibration_;
  Eigen::Index i = 0;
  for_each_parameter(result, [&](Parameter& parameter) { parameter.value = values_[i++]; });
  return result;
}

Placed SensorModel::place(const Measurements& beams, const PlateTrajectory& plate) const {
  check_input(*this, beams, plate);
  Placed result = room_for(beams.size());
  const auto parameters = [&](std::size_t laser) { return chain_values(chains_[laser], values_); };
  trace_all<double>(chains_, parameters, beams, plate,
                    [&](std::size_t measurement, const Beam<double>& beam) {
                      result.points.col(static_cast<Eigen::Index>(result.index.size())) = beam.point();
                      result.index.push_back(static_cast<std::uint32_t>(measurement));
                    });
  shrink(result);
  return result;
}

Placed SensorModel::place(const Measurements& beams, const PlateTrajectory& plate,
                          const std::vector<std::size_t>& free, PointDerivatives& derivatives) const {
  Placed result = place(beams, plate);
  const FreeSlots slots = free_slots(chains_, free);
  derivatives.columns = slots.columns;
  derivatives.stride = 0;
  for (const auto& columns : slots.columns) derivatives.stride = std::max(derivatives.stride, columns.size());
  derivatives.values.setZero(3, static_cast<Eigen::Index>(result.index.size() * derivatives.stride));

  // As many passes as it takes to seed every free parameter in one of a Jet's derivatives.
  constexpr std::size_t kWidth = Jet::DIMENSION;
  for (std::size_t first = 0; first < derivatives.stride; first += kWidth) {
    const auto parameters = [&](std::size_t laser) {
      const auto values = chain_values(chains_[laser], values_);
      std::vector<Jet> seeded(values.begin(), values.end());
      const auto& own = slots.slots[laser];
      for (std::size_t k = first; k < std::min(first + kWidth, own.size()); ++k) {
        seeded[own[k]].v[static_cast<Eigen::Index>(k - first)] = 1;
      }
      return seeded;
    };
    const auto count = static_cast<Eigen::Index>(std::min(kWidth, derivatives.stride - first));
    auto column = static_cast<Eigen::Index>(first);
    trace_all<Jet>(chains_, parameters, beams, plate, [&](std::size_t, const Beam<Jet>& beam) {
      const Vector3<Jet> x = beam.point();
      for (int axis = 0; axis < 3; ++axis) {
        derivatives.values.row(axis).segment(column, count) = x[axis].v.head(count).transpose();
      }
      column += static_cast<Eigen::Index>(derivatives.stride);
    });
  }
  return result;
}

}  // namespace crisp
