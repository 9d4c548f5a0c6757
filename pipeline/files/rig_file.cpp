// SPDX-License-Identifier: BSD-3-Clause
#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <crisp/rig_file.hpp>

#include "pipeline/files/encoder_line_yaml.hpp"
#include "pipeline/files/file_kind.hpp"
#include "pipeline/files/rig_yaml.hpp"
#include "pipeline/files/yaml_map.hpp"

namespace crisp {
namespace {

using files::YamlMap;
using files::YamlNode;

bool is_ip(const std::string& text) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

/// Names become parts of "laser1.tau" and of file names.
bool is_device_name(const std::string& name) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  return !name.empty() && std::all_of(name.begin(), name.end(), allowed);
}

constexpr const char* kNameAdvice = "use letters, digits, _ and - only";

/// Name of the plate in effects and findings.
const std::string kPlate = "plate";

class RigReader {
 public:
  Rig read(const YamlNode& root) {
    YamlMap map(root, "rig", errors_);
    files::check_schema(map, 1);
    if (const YamlNode* lasers = map.require("lasers")) read_lasers(*lasers);
    if (const YamlNode* plate = map.require("plate")) read_plate(*plate);
    map.refuse_others();
    check_addresses();
    if (!errors_.empty()) throw Errors(std::move(errors_));
    return std::move(rig_);
  }

 private:
  void read_lasers(const YamlNode& node) {
    YamlMap map(node, "lasers", errors_);
    if (node.kind == YamlNode::Kind::map && node.entries.empty())
      map.fail(node.place, "there is none", "describe one laser at least");
    constexpr std::size_t kMax = 1000;
    if (node.entries.size() > kMax)
      return map.fail(node.place, fmt::format("there are {}", node.entries.size()),
                      fmt::format("describe {} at most", kMax));
    for (const auto& entry : node.entries) {
      if (!is_device_name(entry.key)) {
        map.fail(entry.place, "'" + entry.key + "' is no name of a device", kNameAdvice);
      }
      if (entry.key == kPlate) {
        map.fail(entry.place, "no laser can be named 'plate'", "effects and findings name the plate by it");
      }
      read_laser(entry);
    }
  }

  void read_laser(const files::YamlEntry& entry) {
    YamlMap map(entry.value, "laser '" + entry.key + "'", errors_);
    RigLaser laser;
    laser.name = entry.key;
    laser.address = read_address(map, 0);
    laser.topic = map.text("topic", "");
    constexpr int kMaxRing = 1023;
    if (map.find("ring")) laser.ring = static_cast<int>(map.integer("ring", 0, 0, kMaxRing));
    laser.mount = angle(map, "mount");
    laser.time_offset = bounded(map, "time_offset", "s", 0, 10);
    laser.period_offset = static_cast<int>(map.integer("period_offset", 0, -100, 100));
    laser.echo = files::read_choice<EchoChoice>(map, "echo",
                                                {{"first", EchoChoice::first},
                                                 {"last", EchoChoice::last},
                                                 {"strongest", EchoChoice::strongest},
                                                 {"all", EchoChoice::all}},
                                                EchoChoice::first, "choice of echoes",
                                                "write first, last, strongest or all");
    laser.nominal.name = laser.name;
    if (const YamlNode* nominal = map.require("nominal")) read_nominal(*nominal, map.what(), laser.nominal);
    map.refuse_others();
    if (laser.name != kPlate) devices_.push_back({laser.name, laser.address, entry.place});
    rig_.lasers.push_back(std::move(laser));
  }

  void read_nominal(const YamlNode& node, const std::string& what, LaserCalibration& nominal) {
    YamlMap map(node, what + ", nominal", errors_);
    map.require("lambda");
    map.require("tau");
    const auto an_angle = [](YamlMap& of, const std::string& key) { return angle(of, key); };
    const auto of_unit = [](std::string_view unit) {
      return [unit](YamlMap& of, const std::string& key) { return bounded(of, key, unit, 0, 10); };
    };
    read_nominal_value(map, nominal.lambda, an_angle);
    read_nominal_value(map, nominal.tau, of_unit("m"));
    read_nominal_value(map, nominal.alpha, an_angle);
    read_nominal_value(map, nominal.eta, of_unit("s"));
    map.refuse_others();
  }

  /// `tau: 20cm`, or `tau: {value: 20cm, sd: 5mm}`.
  ///
  /// @param read  (YamlMap&, key) → the number in SI
  template <class Read>
  void read_nominal_value(YamlMap& map, Parameter& parameter, const Read& read) {
    const YamlNode* node = map.find(parameter.name);
    if (!node || node->kind != YamlNode::Kind::map) {
      parameter.value = read(map, parameter.name);
      return;
    }
    YamlMap inner(*node, map.what() + ", " + parameter.name, errors_);
    inner.require("value");
    parameter.value = read(inner, "value");
    if (const YamlNode* sd = inner.find("sd")) {
      const std::size_t mistakes = errors_.size();
      parameter.std_error = read(inner, "sd");
      if (errors_.size() == mistakes && !(parameter.std_error > 0)) {
        inner.fail(sd->place, "'sd': a standard deviation is above 0", "omit it where it is unknown");
        parameter.std_error = 0;
      }
    }
    inner.refuse_others();
  }

  void read_plate(const YamlNode& node) {
    constexpr int kDefaultPort = 4000;
    YamlMap map(node, "plate", errors_);
    rig_.plate.name = map.text("name", "plate");
    if (!is_device_name(rig_.plate.name)) {
      map.fail(map.find("name")->place, "'" + rig_.plate.name + "' is no name of a device", kNameAdvice);
    }
    rig_.plate.address = read_address(map, kDefaultPort);
    read_joint(map);
    read_encoder(map);
    // Its counter has 32 bits; with one step a turn the direction of the turn would be ambiguous.
    constexpr std::int64_t kMaxSteps = std::int64_t{1} << 31;
    rig_.plate.counts_per_revolution =
        static_cast<double>(map.integer("counts_per_revolution", 16384, 2, kMaxSteps));
    rig_.plate.direction = direction(map);
    map.refuse_others();
    devices_.push_back({rig_.plate.name, rig_.plate.address, node.place});
  }

  /// Reads the place of the plate's angle in a bag.
  void read_joint(YamlMap& map) {
    rig_.plate.topic = map.text("topic", "");
    rig_.plate.joint = map.text("joint", "");
    rig_.plate.field = map.text("field", "");
    if (map.find("unit")) {
      rig_.plate.unit = files::read_choice<AngleUnit>(
          map, "unit", {{"rad", AngleUnit::rad}, {"deg", AngleUnit::deg}, {"counts", AngleUnit::counts}},
          AngleUnit::rad, "unit of an angle", "write rad, deg or counts");
    }
    if (!rig_.plate.joint.empty() && !rig_.plate.field.empty()) {
      map.fail(map.find("field")->place, "'field' and 'joint' are both given",
               "a joint belongs to a JointState, a field to a message of another type; remove one of them");
    }
  }

  /// Reads where the encoder's counts come from, and in what form.
  void read_encoder(YamlMap& map) {
    if (const YamlNode* line = map.find("line")) rig_.plate.line = files::read_encoder_line(*line, errors_);
    const std::string laser = map.text("encoder_of", "");
    if (laser.empty()) return;
    const Place& place = map.find("encoder_of")->place;
    const auto of = std::ranges::find(rig_.lasers, laser, &RigLaser::name);
    if (of == rig_.lasers.end())
      return map.fail(place, "'encoder_of': there is no laser '" + laser + "'",
                      "name the laser whose telegrams carry the encoder's counts");
    rig_.plate.encoder_of = static_cast<std::uint16_t>(of - rig_.lasers.begin());
    if (!rig_.plate.address.ip.empty() || rig_.plate.line)
      map.fail(place, "'encoder_of' and an own 'address' or 'line' are both given",
               "an encoder is wired to a laser, or sends readings of its own; remove one of them");
  }

  static CountDirection direction(YamlMap& map) {
    return files::read_choice<CountDirection>(
        map, "direction",
        {{"counter_clockwise", CountDirection::counter_clockwise},
         {"clockwise", CountDirection::clockwise},
         {"auto", CountDirection::automatic}},
        CountDirection::counter_clockwise, "sense of rotation",
        "write the plate's sense of rotation, seen from +z, while the count grows: counter_clockwise, clockwise, or auto if it is unknown");
  }

  /// None where it is written wrongly: what is not known is nobody else's.
  Address read_address(YamlMap& map, int default_port) {
    const std::size_t mistakes = errors_.size();
    Address address;
    const YamlNode* ip = map.find("address");  // what is read from a table has none
    address.ip = map.text("address", "");
    if (ip && ip->kind == YamlNode::Kind::scalar && !is_ip(address.ip)) {
      map.fail(ip->place, "'" + address.ip + "' is not an IP address", "write it as 192.168.0.1");
    }
    address.port = static_cast<std::uint16_t>(map.integer("port", default_port, 0, 65535));
    return errors_.size() == mistakes ? address : Address{};
  }

  /// An angle of at most a turn, in rad: a larger one was meant in degrees.
  static double angle(YamlMap& map, const std::string& key) {
    constexpr double kMax = 2 * std::numbers::pi * (1 + 1e-9);  // 360deg is still meant
    const double value = map.number(key, "rad", 0);
    if (std::abs(value) <= kMax) return value;
    const YamlNode& node = *map.find(key);
    std::string wrong;
    const bool plain = files::read_number(node, "", wrong).has_value();
    map.fail(node.place, fmt::format("'{}': {}{} is more than a turn", key, node.text, plain ? " rad" : ""),
             plain ? fmt::format("did you mean {}deg?", node.text) : "angles are -360deg to 360deg");
    return 0;
  }

  /// A number whose size cannot be more than `limit`, in SI: beyond it, somebody forgot a unit.
  static double bounded(YamlMap& map, const std::string& key, std::string_view unit, double fallback,
                        double limit) {
    const double value = map.number(key, unit, fallback);
    if (std::abs(value) <= limit) return value;
    map.fail(map.find(key)->place, fmt::format("'{}': {:g} {} is implausible", key, value, unit),
             fmt::format("its magnitude is at most {:g} {}; check the unit", limit, unit));
    return fallback;
  }

  /// Two devices at one address would be indistinguishable.
  void check_addresses() {
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto& [name, address, place] = devices_[i];
        const auto& [other, used, used_at] = devices_[j];
        const bool overlap =
            !address.ip.empty() && (address.port == used.port || address.port == 0 || used.port == 0);
        if (name == other) {
          errors_.emplace_back("rig: two devices are named '" + name + "'", "give one of them another name",
                               place);
        } else if (address.ip == used.ip && overlap) {
          errors_.emplace_back(
              fmt::format("rig: '{}' and '{}' have the same address {}", other, name, address.ip),
              "give each its own (`crisp info` on a recording lists those in it), or ports that differ",
              place);
        }
      }
    }
  }

  /// A device as the file has it.
  struct Device {
    std::string name;
    Address address;
    Place place;
  };

  Rig rig_;
  std::vector<Device> devices_;  ///< all whose name can be used
  std::vector<Error> errors_;
};

}  // namespace

}  // namespace crisp

namespace crisp::files {

Rig parse_rig(const YamlNode& root) { return RigReader().read(root); }

}  // namespace crisp::files

namespace crisp {

Rig read_rig(const std::filesystem::path& file) {
  const YamlNode root = files::read_yaml(file);
  files::refuse_other_kinds(root, file, files::FileKind::rig);
  return files::parse_rig(root);
}

}  // namespace crisp
