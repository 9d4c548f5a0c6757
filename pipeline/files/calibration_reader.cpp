// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>

#include "pipeline/files/calibration_yaml.hpp"
#include "pipeline/files/file_kind.hpp"
#include "pipeline/files/renamed_names.hpp"
#include "pipeline/files/yaml_map.hpp"

namespace crisp {
namespace {

using files::YamlMap;
using files::YamlNode;

/// Sizes beyond which a value is implausible, in SI.
constexpr double kLargestAngle = 100, kLargestOffset = 10, kLargestLag = 10;

class CalibrationReader {
 public:
  explicit CalibrationReader(const JudgeTerm& judge) : judge_(judge) {}

  Calibration read(const YamlNode& root) {
    YamlMap map(root, "calibration", errors_);
    files::check_schema(map, 1);
    if (map.find("caveats")) calibration_.caveats = texts(map, "caveats");
    if (const YamlNode* lasers = map.require("lasers")) read_lasers(*lasers);
    if (const YamlNode* plate = map.find("plate")) read_plate(*plate);
    if (const YamlNode* covariance = map.find("covariance")) read_covariance(*covariance);
    if (const YamlNode* quality = map.find("quality")) read_quality(*quality);
    if (const YamlNode* provenance = map.find("provenance")) read_provenance(*provenance);
    map.refuse_others();
    if (!errors_.empty()) throw Errors(std::move(errors_));
    return std::move(calibration_);
  }

 private:
  void read_lasers(const YamlNode& node) {
    YamlMap map(node, "lasers", errors_);
    if (node.kind == YamlNode::Kind::map && node.entries.empty())
      map.fail(node.place, "there is none", "give the calibration of one laser at least");
    for (const auto& [name, place, value] : node.entries) {
      YamlMap laser_map(value, "laser '" + name + "'", errors_);
      LaserCalibration laser;
      laser.name = name;
      read_base(laser_map, laser.lambda, kLargestAngle);
      read_base(laser_map, laser.tau, kLargestOffset);
      read_base(laser_map, laser.alpha, kLargestAngle);
      read_base(laser_map, laser.eta, kLargestLag);
      if (const YamlNode* terms = laser_map.find("terms")) {
        laser.terms = read_terms(*terms, laser_map.what(), TermOwner::laser);
      }
      laser_map.refuse_others();
      calibration_.lasers.push_back(std::move(laser));
    }
  }

  /// One of λ, τ, α, η.
  void read_base(YamlMap& laser, Parameter& parameter, double largest) {
    const YamlNode* found = laser.require(parameter.name);
    if (!found) return;
    parameter = read_parameter(*found, parameter.name, laser.what(), parameter.unit);
    if (std::abs(parameter.value) <= largest) return;
    laser.fail(found->place,
               fmt::format("'{}': {:g} {} is implausible", parameter.name, parameter.value, parameter.unit),
               fmt::format("its magnitude is at most {:g} {}", largest, parameter.unit));
  }

  void read_plate(const YamlNode& node) {
    YamlMap map(node, "plate", errors_);
    const std::string direction = map.text("direction", "counter_clockwise");
    if (direction == "clockwise") {
      calibration_.direction = CountDirection::clockwise;
    } else if (direction != "counter_clockwise") {
      map.fail(map.find("direction")->place, "'direction': '" + direction + "' is no sense of rotation",
               "a calibration holds for counter_clockwise or clockwise");
    }
    if (const YamlNode* terms = map.find("terms")) {
      calibration_.plate_terms = read_terms(*terms, "plate", TermOwner::plate);
    }
    map.refuse_others();
  }

  std::vector<TermParameters> read_terms(const YamlNode& node, const std::string& what, TermOwner owner) {
    YamlMap map(node, what + ", terms", errors_);
    std::vector<TermParameters> terms;
    for (const auto& [name, place, value] : node.entries) {
      YamlMap term_map(value, fmt::format("{}, term '{}'", what, name), errors_);
      TermParameters term{name, {}};
      const std::size_t wrong_before = errors_.size();
      for (const auto& entry : value.entries) {
        term.parameters.push_back(read_parameter(entry.value, entry.key, term_map.what(), {}));
      }
      if (judge_ && errors_.size() == wrong_before) {
        for (const auto& fault : judge_(term, owner)) {
          const YamlNode* parameter = value.find(fault.parameter);
          term_map.fail(parameter ? parameter->place : place, fault.what, fault.advice);
        }
      }
      terms.push_back(std::move(term));
    }
    return terms;
  }

  /// @param unit  the only valid unit, or empty where the file states it
  Parameter read_parameter(const YamlNode& node, const std::string& name, const std::string& what,
                           const std::string& unit) {
    YamlMap map(node, what + ", " + name, errors_);
    Parameter parameter{name, unit};
    map.require("value");
    parameter.value = map.number("value", "", 0);
    parameter.std_error = map.number("std_error", "", 0);
    parameter.free = map.boolean("free", false);
    const YamlNode* written = map.require("unit");
    if (written) parameter.unit = map.text("unit", unit);
    if (written && !unit.empty() && parameter.unit != unit) {
      map.fail(written->place, files::describe(*written) + " is not its unit",
               "convert the value to " + unit);
    }
    if (written && parameter.unit.empty())
      map.fail(written->place, "there is no unit", "write 1 for a plain number");
    if (parameter.std_error < 0)
      map.fail(node.find("std_error")->place, fmt::format("the standard error is {:g}", parameter.std_error),
               "give 0 or more");
    map.refuse_others();
    return parameter;
  }

  void read_covariance(const YamlNode& node) {
    YamlMap map(node, "covariance", errors_);
    std::string wrong;
    calibration_.covariance_order = texts(map, "order");
    if (const YamlNode* values = list(map, "values")) {
      for (const auto& item : values->items) {
        if (const auto number = files::read_number(item, "", wrong))
          calibration_.covariance.push_back(*number);
        else
          map.fail(item.place, "'values': " + wrong, files::expected_number(""));
      }
      const std::size_t m = calibration_.covariance_order.size();
      if (values->items.size() != m * m) {
        map.fail(values->place, fmt::format("there are {} values for {} parameters", values->items.size(), m),
                 fmt::format("write {} x {}, row by row", m, m));
      }
    }
    map.refuse_others();
  }

  static const YamlNode* list(YamlMap& map, const std::string& key) {
    const YamlNode* node = map.require(key);
    if (!node || node->kind == YamlNode::Kind::sequence) return node;
    map.fail(node->place, "'" + key + "': " + files::describe(*node) + " is not a list", "write [a, b]");
    return nullptr;
  }

  static std::vector<std::string> texts(YamlMap& map, const std::string& key) {
    std::vector<std::string> read;
    const YamlNode* node = list(map, key);
    if (!node) return read;
    for (const auto& item : node->items) {
      std::string wrong;
      if (auto text = files::read_text(item, wrong))
        read.push_back(std::move(*text));
      else
        map.fail(item.place, fmt::format("'{}': {}", key, wrong), "expected is a text");
    }
    return read;
  }

  /// Plain figures, figures with a before and an after, and what could not be observed.
  void read_quality(const YamlNode& node) {
    YamlMap map(node, "quality", errors_);
    if (const YamlNode* unobservable = map.find("unobservable")) read_unobservable(*unobservable, map);
    for (const auto& [name, place, value] : node.entries) {
      if (name == "unobservable") continue;
      if (value.kind == YamlNode::Kind::map) {
        YamlMap pair(value, "quality, " + name, errors_);
        for (const char* when : {"before", "after"}) {
          if (pair.find(when)) calibration_.quality[name + "_" + when] = pair.number(when, "", 0);
        }
        pair.refuse_others();
      } else {
        std::string wrong;
        if (const auto figure = files::read_number(value, "", wrong))
          calibration_.quality[name] = *figure;
        else
          map.fail(value.place, fmt::format("'{}': {}", name, wrong), files::expected_number(""));
      }
    }
  }

  void read_unobservable(const YamlNode& node, YamlMap& parent) {
    if (node.kind != YamlNode::Kind::sequence) {
      parent.fail(node.place, "'unobservable': " + files::describe(node) + " is not a list",
                  "write [{parameter: NAME}]");
    }
    for (const auto& item : node.items) {
      YamlMap map(item, "quality, unobservable", errors_);
      map.require("parameter");
      calibration_.unobservable.push_back(
          {map.text("parameter", ""), map.text("reason", ""), map.text("combination", "")});
      map.refuse_others();
    }
  }

  void read_provenance(const YamlNode& node) {
    YamlMap map(node, "provenance", errors_);
    for (const auto& [key, place, value] : node.entries) {
      std::string wrong;
      if (auto text = files::read_text(value, wrong))
        calibration_.provenance[key] = std::move(*text);
      else
        map.fail(value.place, fmt::format("'{}': {}", key, wrong), "expected is a text");
    }
  }

  const JudgeTerm& judge_;
  Calibration calibration_;
  std::vector<Error> errors_;
};

}  // namespace

}  // namespace crisp

namespace crisp::files {

Calibration parse_calibration(const YamlNode& root, const JudgeTerm& judge) {
  return CalibrationReader(judge).read(root);
}

}  // namespace crisp::files

namespace crisp {

Calibration read_calibration(const std::filesystem::path& file, const JudgeTerm& judge,
                             const files::OldNameSink& warn) {
  YamlNode root = files::read_yaml(file);
  files::refuse_other_kinds(root, file, files::FileKind::calibration);
  files::rename_old_keys(root, "calibration", warn);
  return files::parse_calibration(root, judge);
}

}  // namespace crisp
