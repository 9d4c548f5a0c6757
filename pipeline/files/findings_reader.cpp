// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "pipeline/files/findings_file.hpp"
#include "pipeline/files/yaml_map.hpp"

namespace crisp::files {
namespace {

/// One map of the file, whose keys are all required.
class FindingsMap {
 public:
  FindingsMap(const YamlNode& node, std::string what, std::vector<Error>& errors)
      : map_(node, std::move(what), errors), errors_(errors) {}

  std::string text(const std::string& key) {
    map_.require(key);
    return map_.text(key, {});
  }
  /// Empty for files of earlier versions without the key.
  std::string text_if_there(const std::string& key) { return map_.text(key, {}); }
  bool boolean(const std::string& key) {
    map_.require(key);
    return map_.boolean(key, false);
  }
  std::size_t count(const std::string& key) {
    map_.require(key);
    return static_cast<std::size_t>(map_.integer(key, 0, 0, std::numeric_limits<std::int64_t>::max()));
  }
  /// JSON has no NaN: it is written as null.
  double number(const std::string& key) {
    const YamlNode* node = map_.require(key);
    if (node && node->kind == YamlNode::Kind::null) return std::numeric_limits<double>::quiet_NaN();
    return map_.number(key, "", 0);
  }
  /// Calls read(item, where), where being "findings[2]".
  template <class Read>
  void each(const std::string& key, Read read) {
    const YamlNode* node = map_.require(key);
    if (!node) return;
    if (node->kind != YamlNode::Kind::sequence) {
      return map_.fail(node->place, "'" + key + "': " + describe(*node) + " is not a list",
                       "run the diagnosis again, or correct the file");
    }
    for (std::size_t i = 0; i < node->items.size(); ++i) read(node->items[i], fmt::format("{}[{}]", key, i));
  }
  /// The same, where files of an earlier program lack the key.
  template <class Read>
  void each_if_there(const std::string& key, Read read) {
    if (map_.find(key)) each(key, read);
  }
  std::vector<std::string> texts(const std::string& key) {
    std::vector<std::string> all;
    each(key, [&](const YamlNode& item, const std::string& where) {
      std::string wrong;
      if (auto text = read_text(item, wrong)) {
        all.push_back(std::move(*text));
      } else {
        map_.fail(item.place, where + ": " + wrong, "expected is a text");
      }
    });
    return all;
  }
  /// A list of `n` numbers.
  template <std::size_t n>
  std::array<double, n> numbers(const std::string& key) {
    std::array<double, n> all{};
    const YamlNode* node = map_.require(key);
    if (!node) return all;
    if (node->kind != YamlNode::Kind::sequence || node->items.size() != n) {
      map_.fail(node->place, fmt::format("'{}': {} is not a list of {} numbers", key, describe(*node), n),
                "run the diagnosis again, or correct the file");
      return all;
    }
    for (std::size_t i = 0; i < n; ++i) {
      std::string wrong;
      const bool unknown = node->items[i].kind == YamlNode::Kind::null;
      const auto number = unknown ? std::nullopt : read_number(node->items[i], "", wrong);
      all[i] = number.value_or(std::numeric_limits<double>::quiet_NaN());
      if (!wrong.empty())
        map_.fail(node->items[i].place, fmt::format("'{}': {}", key, wrong), expected_number(""));
    }
    return all;
  }
  YamlMap& map() { return map_; }
  std::vector<Error>& errors() { return errors_; }

 private:
  YamlMap map_;
  std::vector<Error>& errors_;
};

/// Reads the maps of a list.
/// @param inside  what holds the list, for errors; empty: the file
template <class Thing>
std::vector<Thing> read_list(FindingsMap& parent, const char* key,
                             Thing (*read)(FindingsMap&, const std::string& place),
                             const std::string& inside = {}, bool is_required = true) {
  std::vector<Thing> all;
  const auto read_one = [&](const YamlNode& node, const std::string& where) {
    const std::string place = inside.empty() ? where : inside + ", " + where;
    FindingsMap map(node, place, parent.errors());
    all.push_back(read(map, place));
    map.map().refuse_others();
  };
  if (is_required) {
    parent.each(key, read_one);
  } else {
    parent.each_if_there(key, read_one);
  }
  return all;
}

Gain gain_in(FindingsMap& map, const std::string&) {
  return {.metric = map.text("metric"),
          .unit = map.text("unit"),
          .before = map.number("before"),
          .after = map.number("after"),
          .ci95 = map.numbers<2>("ci95")};
}

Parameter parameter_in(FindingsMap& map, const std::string&) {
  return {.name = map.text("name"),
          .unit = map.text("unit"),
          .value = map.number("value"),
          .std_error = map.number("std_error")};
}

OtherCause alternative_in(FindingsMap& map, const std::string&) {
  return {.cause = map.text("cause"),
          .scope = map.text("scope"),
          .log10_bayes_factor = map.number("log10_bayes_factor")};
}

AcceptanceTest test_in(FindingsMap& map, const std::string&) {
  return {.name = map.text("name"),
          .statistic = map.number("statistic"),
          .threshold = map.number("threshold"),
          .p_value = map.number("p_value"),
          .passed = map.boolean("passed")};
}

Finding finding_in(FindingsMap& map, const std::string& what) {
  return {.cause = map.text("cause"),
          .scope = map.text("scope"),
          .parameters = read_list(map, "parameters", parameter_in, what),
          .explained_fraction = map.number("explained_fraction"),
          .log10_bayes_factor = map.number("log10_bayes_factor"),
          .p_value = map.number("p_value"),
          .confounded_with = map.texts("confounded_with"),
          .resolvable_by = map.texts("resolvable_by"),
          .alternatives = read_list(map, "alternatives", alternative_in, what, false),
          .gain = read_list(map, "gain", gain_in, what),
          .tests = read_list(map, "tests", test_in, what, false),
          .accepted = map.boolean("accepted"),
          .rejection = map.text_if_there("rejection_reason")};
}

UnnamedFinding unnamed_in(FindingsMap& map, const std::string& what) {
  return {.covariate = map.text("covariate"),
          .quantity = map.text("quantity"),
          .scope = map.text("scope"),
          .amplitude = map.number("amplitude"),
          .unit = map.text("unit"),
          .p_value = map.number("p_value"),
          .gain = read_list(map, "gain", gain_in, what),
          .accepted = map.boolean("accepted")};
}

ResidualDeparture departure_in(FindingsMap& map, const std::string&) {
  return {.covariate = map.text("covariate"),
          .quantity = map.text("quantity"),
          .scope = map.text("scope"),
          .amplitude = map.number("amplitude"),
          .unit = map.text("unit"),
          .p_value = map.number("p_value"),
          .amplitude_after = map.number("amplitude_after"),
          .p_value_after = map.number("p_value_after")};
}

Unobservable unobservable_in(FindingsMap& map, const std::string&) {
  return {map.text("cause"), map.text("reason"), map.text("combination")};
}

EstimatorArtifact artifact_in(FindingsMap& map, const std::string& what) {
  return {.name = map.text("artifact"),
          .parameters = read_list(map, "parameters", parameter_in, what),
          .reason = map.text("reason")};
}

DeviceFacts device_in(FindingsMap& map, const std::string&) {
  return {.device = map.text("device"),
          .stamps = map.count("stamps"),
          .skew = map.number("skew"),
          .skew_std_error = map.number("skew_std_error"),
          .delay_median = map.number("delay_median"),
          .delay_95 = map.number("delay_95"),
          .period = map.number("period"),
          .period_std_error = map.number("period_std_error"),
          .nominal_period = map.number("nominal_period"),
          .wander = map.number("wander")};
}

NoiseFacts noise_in(FindingsMap& map, const std::string&) {
  return {.laser = map.text("laser"), .ranges = map.count("ranges"), .sigma = map.number("sigma")};
}

}  // namespace

Findings parse_findings(const YamlNode& root) {
  std::vector<Error> errors;
  FindingsMap map(root, "findings of a diagnosis", errors);
  check_schema(map.map(), 1);
  Findings all;
  all.findings = read_list(map, "findings", finding_in);
  all.unnamed = read_list(map, "unnamed", unnamed_in);
  all.departures = read_list(map, "departures", departure_in, {}, false);
  all.unobservable = read_list(map, "unobservable", unobservable_in);
  all.artifacts = read_list(map, "artifacts", artifact_in);
  all.devices = read_list(map, "devices", device_in);
  all.noise = read_list(map, "noise", noise_in);
  all.gain = read_list(map, "gain", gain_in, {}, false);
  if (const YamlNode* node = map.map().require("goodness_of_fit")) {
    FindingsMap alike(*node, "goodness_of_fit", errors);
    all.before_p = alike.number("before_p");
    all.after_p = alike.number("after_p");
    alike.map().refuse_others();
  }
  map.map().refuse_others();
  if (!errors.empty()) throw Errors(std::move(errors));
  return all;
}

Findings read_findings(const std::filesystem::path& file, const OldNameSink& warn) {
  std::ifstream stream(file);  // reading reports whether it can be read
  if (stream && !nlohmann::json::accept(stream))
    throw Error("this is not JSON", "it was truncated, or edited", {.file = file.string()});
  YamlNode root = read_yaml(file);
  rename_old_keys(root, "diagnosis", warn);
  return parse_findings(root);
}

}  // namespace crisp::files
