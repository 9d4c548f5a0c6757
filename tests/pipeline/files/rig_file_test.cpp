// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include <crisp/rig_file.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/files/rig_yaml.hpp"
#include "tests/pipeline/files/errors_of.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::files;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> errors_of_rig(const std::string& text) {
  return errors_of([&] { parse_rig(parse_yaml(text, "rig.yaml")); });
}

TEST(RigFile, ReadsTheDefaultRigOfTheConfigs) {
  const Rig rig = read_rig(source_dir() + "/configs/rig.yaml");
  const Rig expected = default_rig();
  ASSERT_EQ(rig.lasers.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rig.lasers[i].name, expected.lasers[i].name);
    EXPECT_EQ(rig.lasers[i].address, expected.lasers[i].address);
    EXPECT_DOUBLE_EQ(rig.lasers[i].mount, 45 * kDegree);
    EXPECT_DOUBLE_EQ(rig.lasers[i].nominal.tau.value, 0.2);
    EXPECT_DOUBLE_EQ(rig.lasers[i].nominal.lambda.value, static_cast<double>(i) * 120 * kDegree);
    EXPECT_EQ(rig.lasers[i].nominal.name, rig.lasers[i].name);
    EXPECT_EQ(rig.lasers[i].nominal.eta.value, 0);
  }
  EXPECT_EQ(rig.plate.address, expected.plate.address);
  EXPECT_EQ(rig.plate.counts_per_revolution, 16384);
}

TEST(RigFile, ReadsHowWellANominalValueIsKnown) {
  const auto text = [](const std::string& lambda) {
    return "crisp: 1\nplate: {}\nlasers:\n  a: {nominal: {tau: {value: 20cm, sd: 5mm}, lambda: " + lambda +
           "}}";
  };
  const LaserCalibration nominal =
      parse_rig(parse_yaml(text("{value: 120deg, sd: 5deg}"), "rig.yaml")).lasers[0].nominal;
  EXPECT_DOUBLE_EQ(nominal.lambda.value, 120 * kDegree);
  EXPECT_DOUBLE_EQ(nominal.lambda.std_error, 5 * kDegree);
  EXPECT_DOUBLE_EQ(nominal.tau.value, 0.2);
  EXPECT_DOUBLE_EQ(nominal.tau.std_error, 0.005);
  EXPECT_EQ(nominal.alpha.std_error, 0);
  EXPECT_THAT(
      errors_of_rig(text("{value: 1deg, sd: 0}")),
      ElementsAre(HasSubstr(
          "rig.yaml:4:72: error: laser 'a', nominal, lambda: 'sd': a standard deviation is above 0")));
  EXPECT_THAT(errors_of_rig(text("{sd: 1deg}")), ElementsAre(HasSubstr("'value' is missing")));
  EXPECT_THAT(errors_of_rig(text("{value: 1deg, std: 1deg}")), ElementsAre(HasSubstr("'std'")));
}

TEST(RigFile, ReadsTheDirectionInWhichTheEncoderCounts) {
  const auto direction_of = [](const std::string& direction) {
    const std::string text = "crisp: 1\nlasers: {a: {nominal: {lambda: 0, tau: 0}}}\nplate: {direction: ";
    return parse_rig(parse_yaml(text + direction + "}", "rig.yaml")).plate;
  };
  EXPECT_EQ(direction_of("counter_clockwise").direction, CountDirection::counter_clockwise);
  EXPECT_EQ(direction_of("auto").direction, CountDirection::automatic);
  EXPECT_EQ(direction_of("clockwise").direction, CountDirection::clockwise);
  EXPECT_DOUBLE_EQ(direction_of("clockwise").angle_per_count(), -360 * kDegree / 16384);
  EXPECT_THAT(
      errors_of_rig("crisp: 1\nlasers: {a: {nominal: {lambda: 0, tau: 0}}}\nplate: {direction: left}"),
      ElementsAre(HasSubstr("rig.yaml:3:20: error: plate: 'direction': 'left' is no sense of rotation")));
}

TEST(RigFile, ReadsOneLaserWithEveryKey) {
  const Rig rig = parse_rig(parse_yaml(R"(
crisp: 1
plate: {name: table, address: "10.0.0.9", port: 5000, counts_per_revolution: 8192}
lasers:
  front:
    {address: 10.0.0.1, port: 2111, mount: -45deg, time_offset: 0.78ms, period_offset: -1,
     nominal: {lambda: 10deg, tau: 150mm, alpha: -2deg, eta: -30ms}}
)",
                                       "rig.yaml"));
  ASSERT_EQ(rig.lasers.size(), 1u);
  const RigLaser& laser = rig.lasers[0];
  EXPECT_EQ(laser.address, (Address{"10.0.0.1", 2111}));
  EXPECT_DOUBLE_EQ(laser.mount, -45 * kDegree);
  EXPECT_DOUBLE_EQ(laser.time_offset, 0.78e-3);
  EXPECT_EQ(laser.period_offset, -1);
  EXPECT_DOUBLE_EQ(laser.nominal.lambda.value, 10 * kDegree);
  EXPECT_DOUBLE_EQ(laser.nominal.tau.value, 0.15);
  EXPECT_DOUBLE_EQ(laser.nominal.alpha.value, -2 * kDegree);
  EXPECT_DOUBLE_EQ(laser.nominal.eta.value, -0.03);
  EXPECT_EQ(rig.plate.name, "table");
  EXPECT_EQ(rig.plate.address, (Address{"10.0.0.9", 5000}));
  EXPECT_EQ(rig.plate.counts_per_revolution, 8192);
  EXPECT_DOUBLE_EQ(rig.plate.angle_per_count(), 360 * kDegree / 8192);
}

TEST(RigFile, ReadsWhereABagHasItsDevices) {
  const auto rig = [](const std::string& plate) {
    return "crisp: 1\nlasers: {a: {topic: /scan, nominal: {lambda: 0, tau: 0}}}\nplate: {" + plate + "}\n";
  };
  const Rig joint = parse_rig(parse_yaml(rig("topic: /joints, joint: tilt"), "rig.yaml"));
  EXPECT_EQ(joint.lasers[0].topic, "/scan");
  EXPECT_EQ(joint.plate.topic, "/joints");
  EXPECT_EQ(joint.plate.joint, "tilt");
  EXPECT_EQ(joint.plate.unit, std::nullopt);
  const Rig field = parse_rig(parse_yaml(rig("topic: /slice, field: step, unit: deg"), "rig.yaml"));
  EXPECT_EQ(field.plate.field, "step");
  EXPECT_EQ(field.plate.unit, AngleUnit::deg);
  EXPECT_THAT(errors_of_rig(rig("unit: mm")), ElementsAre(HasSubstr("write rad, deg or counts")));
  EXPECT_THAT(errors_of_rig(rig("joint: a, field: b")), ElementsAre(HasSubstr("remove one of them")));
}

TEST(RigFile, ReadsWhichRingOfA3DLaserIsALaser) {
  const auto rig = [](const std::string& ring) {
    return "crisp: 1\nlasers: {a: {" + ring + "nominal: {lambda: 0, tau: 0}}}\nplate: {}\n";
  };
  EXPECT_EQ(parse_rig(parse_yaml(rig(""), "rig.yaml")).lasers[0].ring, std::nullopt);
  EXPECT_EQ(parse_rig(parse_yaml(rig("ring: 0, "), "rig.yaml")).lasers[0].ring, 0);
  EXPECT_THAT(errors_of_rig(rig("ring: -1, ")), ElementsAre(HasSubstr("'ring'")));
}

TEST(RigFile, ReadsTheChoiceOfEchoes) {
  const auto rig = [](const std::string& echo) {
    return "crisp: 1\nlasers: {a: {" + echo + "nominal: {lambda: 0, tau: 0}}}\nplate: {}\n";
  };
  EXPECT_EQ(parse_rig(parse_yaml(rig(""), "rig.yaml")).lasers[0].echo, EchoChoice::first);
  EXPECT_EQ(parse_rig(parse_yaml(rig("echo: all, "), "rig.yaml")).lasers[0].echo, EchoChoice::all);
  EXPECT_THAT(errors_of_rig(rig("echo: second, ")),
              ElementsAre(HasSubstr("write first, last, strongest or all")));
}

TEST(RigFile, ReadsTheLaserThatTheEncoderIsWiredTo) {
  const auto rig = [](const std::string& plate) {
    return "crisp: 1\nplate: {" + plate +
           "}\nlasers: {a: {nominal: {lambda: 0, tau: 0}}, b: {nominal: {lambda: 1, tau: 0}}}\n";
  };
  EXPECT_EQ(parse_rig(parse_yaml(rig("encoder_of: b"), "rig.yaml")).plate.encoder_of, 1);
  EXPECT_THAT(errors_of_rig(rig("encoder_of: c")), ElementsAre(HasSubstr("there is no laser 'c'")));
  EXPECT_THAT(errors_of_rig(rig("encoder_of: a, address: 10.0.0.1")),
              ElementsAre(HasSubstr("remove one of them")));
}

TEST(RigFile, ReadsTheLineOfAnEncodersOwn) {
  const auto rig = [](const std::string& line) {
    return "crisp: 1\nlasers: {a: {nominal: {lambda: 0, tau: 0}}}\nplate: {line: {" + line + "}}\n";
  };
  const EncoderLine line =
      *parse_rig(
           parse_yaml(
               rig("begin: $ENC, separators: ';', time_column: 1, time_unit: ms, count_column: 3, checksum: crc8"),
               "rig.yaml"))
           .plate.line;
  EXPECT_EQ(line.begin, "$ENC");
  EXPECT_EQ(line.separators, ";");
  EXPECT_EQ(line.time_column, 1U);
  EXPECT_EQ(line.count_column, 3U);
  EXPECT_EQ(line.time_unit, 1e-3);
  EXPECT_EQ(line.checksum, LineChecksum::crc8);
  EXPECT_THAT(errors_of_rig(rig("begin: E")), ElementsAre(HasSubstr("'count_column' is missing")));
  EXPECT_THAT(errors_of_rig(rig("count_column: 2, time_column: 2")), ElementsAre(HasSubstr("are the same")));
  EXPECT_THAT(errors_of_rig(rig("count_column: 2, separators: '-'")),
              ElementsAre(HasSubstr("characters of numbers")));
  EXPECT_THAT(errors_of_rig(rig("count_column: 2, checksum: md5")),
              ElementsAre(HasSubstr("write none, xor or crc8")));
}

TEST(RigFile, ReportsEveryMistakeWithItsPlace) {
  EXPECT_THAT(
      errors_of_rig(R"(crisp: 1
lasers:
  laser 1:
    address: 192.168.0.300
    port: 99999
    muont: 45deg
    nominal: {lambda: 45m, tau: 200}
plate: {counts_per_revolution: 0}
)"),
      ElementsAre(
          HasSubstr("rig.yaml:3:3: error: lasers: 'laser 1' is no name of a device; use letters"),
          HasSubstr("rig.yaml:4:14: error: laser 'laser 1': '192.168.0.300' is not an IP address"),
          HasSubstr("rig.yaml:5:11: error: laser 'laser 1': 'port': 99999 is not from 0 to 65535"),
          HasSubstr(
              "rig.yaml:7:23: error: laser 'laser 1', nominal: 'lambda': '45m' cannot be converted to rad"),
          HasSubstr("rig.yaml:7:33: error: laser 'laser 1', nominal: 'tau': 200 m is implausible"),
          HasSubstr("rig.yaml:6:5: error: laser 'laser 1': there is no key 'muont'; did you mean 'mount'?"),
          HasSubstr("rig.yaml:8:32: error: plate: 'counts_per_revolution': 0 is not from 2 to 2147483648")));
}

std::vector<std::string> errors_of_plate(const std::string& plate, const std::string& laser = "a") {
  return errors_of([&] {
    parse_rig(parse_yaml(
        "crisp: 1\nlasers: {" + laser + ": {nominal: {lambda: 0, tau: 0}}}\nplate: " + plate + "\n",
        "rig.yaml"));
  });
}

TEST(RigFile, NamesAreOfWhatFilesCanBeNamedAfter) {
  for (const char* name : {"../../escaped", "/tmp/x", "a b", "", "a\\nb"}) {
    EXPECT_THAT(errors_of_plate("{name: \"" + std::string(name) + "\"}"),
                ElementsAre(HasSubstr("use letters, digits, _ and - only")))
        << name;
  }
  EXPECT_THAT(errors_of_plate("{name: servo-1}"), testing::IsEmpty());
  EXPECT_THAT(errors_of_plate("{name: servo}", "plate"),
              ElementsAre(HasSubstr("no laser can be named 'plate'")));
}

TEST(RigFile, AnEncoderHasAWholeNumberOfSteps) {
  for (const char* counts : {"1", "16384.5", "-4", "1e19", "4294967296"}) {
    EXPECT_THAT(errors_of_plate("{counts_per_revolution: " + std::string(counts) + "}"),
                ElementsAre(HasSubstr("rig.yaml:3:32: error: plate: 'counts_per_revolution'")))
        << counts;
  }
  EXPECT_THAT(errors_of_plate("{counts_per_revolution: 2}"), testing::IsEmpty());
  EXPECT_THAT(errors_of_plate("{counts_per_revolution: 2147483648}"), testing::IsEmpty());
}

TEST(RigFile, RefusesAnglesWhoseUnitWasForgotten) {
  EXPECT_THAT(
      errors_of_rig("crisp: 1\nplate: {}\nlasers:\n  a:\n    mount: 45\n"
                    "    nominal: {lambda: -60, tau: 0, alpha: 400deg}\n"),
      ElementsAre(
          HasSubstr(
              "rig.yaml:5:12: error: laser 'a': 'mount': 45 rad is more than a turn; did you mean 45deg?"),
          HasSubstr(
              "rig.yaml:6:23: error: laser 'a', nominal: 'lambda': -60 rad is more than a turn; did you mean -60deg?"),
          HasSubstr(
              "rig.yaml:6:43: error: laser 'a', nominal: 'alpha': 400deg is more than a turn; angles are -360deg to 360deg")));
  const Rig rig = parse_rig(parse_yaml(
      "crisp: 1\nplate: {}\nlasers: {a: {mount: -360deg, nominal: {lambda: 1turn, tau: 0, alpha: 6.28}}}\n",
      "rig.yaml"));
  EXPECT_DOUBLE_EQ(rig.lasers[0].nominal.lambda.value, 360 * kDegree);
}

TEST(RigFile, RefusesIndistinguishableDevices) {
  const std::string laser = "{address: 10.0.0.1, nominal: {lambda: 0, tau: 0}}";
  EXPECT_THAT(errors_of_rig("crisp: 1\nlasers:\n  a: " + laser + "\n  b: " + laser +
                            "\nplate: {address: 10.0.0.2}\n"),
              ElementsAre(HasSubstr("rig.yaml:4:3: error: rig: 'a' and 'b' have the same address 10.0.0.1")));
  EXPECT_THAT(errors_of_rig("crisp: 1\nlasers:\n  a: " + laser + "\nplate: {name: a, address: 10.0.0.2}\n"),
              ElementsAre(HasSubstr("two devices are named 'a'")));
  EXPECT_THAT(errors_of_rig("crisp: 1\nlasers:\n  a: " + laser +
                            "\n  b: {address: 10.0.0.1, port: 99999, nominal: {lambda: 0, tau: 0}}\n"
                            "plate: {address: 10.0.0.2}\n"),
              ElementsAre(HasSubstr("99999")))
      << "a port that is not known is nobody else's";
  EXPECT_THAT(
      errors_of_rig("crisp: 1\nlasers:\n  a: " + laser + "\n  b: " + laser + "\nplate: {prot: 1}\n"),
      ElementsAre(HasSubstr("there is no key 'prot'"), HasSubstr("'a' and 'b' have the same address")));
}

TEST(RigFile, TheExampleOfItsPageIsOne) {
  std::ifstream page(source_dir() + "/docs/how-to/describe-a-rig.md");
  std::string example;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("    ") && !example.empty()) break;  // further ones are no rigs
    if (line.starts_with("    ")) example += line.substr(4) + "\n";
  }
  const Rig rig = parse_rig(parse_yaml(example, "rig.md"));
  ASSERT_EQ(rig.lasers.size(), 2U);
  EXPECT_EQ(rig.lasers[1].name, "rear");
  EXPECT_DOUBLE_EQ(rig.lasers[1].nominal.lambda.value, 180 * kDegree);
}

TEST(RigFile, NeedsNoAddressesForWhatIsReadFromATable) {
  const Rig rig = parse_rig(parse_yaml(
      "crisp: 1\nlasers: {a: {nominal: {lambda: 0, tau: 0}}, b: {nominal: {lambda: 0, tau: 0}}}\nplate: {name: tilt}\n",
      "rig.yaml"));
  EXPECT_EQ(rig.lasers.size(), 2u);
  EXPECT_EQ(rig.lasers[0].address.ip, "");
  EXPECT_EQ(rig.plate.address.ip, "");
}

TEST(RigFile, RefusesARigWithoutLasersAndOtherVersions) {
  EXPECT_THAT(errors_of_rig("crisp: 1\nlasers: {}\nplate: {address: 10.0.0.2}\n"),
              ElementsAre(HasSubstr("lasers: there is none")));
  EXPECT_THAT(errors_of_rig("crisp: 2\nlasers: {a: {address: 10.0.0.1, nominal: {lambda: 0, tau: 0}}}\n"
                            "plate: {address: 10.0.0.2}\n"),
              ElementsAre(HasSubstr("it has schema version 2, and this program reads up to version 1")));
  EXPECT_THAT(errors_of_rig("[1, 2]"), ElementsAre(HasSubstr("rig: a list is not a map")));
  EXPECT_THAT(errors_of_rig(""), ElementsAre(HasSubstr("rig: nothing is not a map")));
}

}  // namespace
}  // namespace crisp
