// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <crisp/sensor_model.hpp>

namespace crisp::diagnose {

/// Results that depend on a sensor model alone, each computed once.
template <class Result>
class PerModel {
 public:
  /// The result of the model with these terms and values.
  ///
  /// @param compute  called for a model that was not asked for before
  template <class Compute>
  const Result& of(const SensorModel& model, Compute compute) {
    Key key{model.names(), {model.values().begin(), model.values().end()}};
    const auto known = results_.find(key);
    return known != results_.end() ? known->second
                                   : results_.emplace(std::move(key), compute()).first->second;
  }

 private:
  using Key = std::pair<std::vector<std::string>, std::vector<double>>;
  std::map<Key, Result> results_;
};

}  // namespace crisp::diagnose
