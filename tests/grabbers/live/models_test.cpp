// SPDX-License-Identifier: BSD-3-Clause
// The devices that grabber.sick is for, as they configure their scans, in both languages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grabbers/emulate/emulator.hpp"
#include "grabbers/live/live_source.hpp"
#include "grabbers/wire/scan_encoding.hpp"
#include "pipeline/data/degree.hpp"
#include "tests/grabbers/live/live_support.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::emulate;
using namespace crisp::live;

struct Model {
  std::string name;
  double frequency = 50;  ///< [Hz]
  double first = -45;     ///< [deg]
  double step = 0.5;      ///< [deg]
  std::size_t beams = 541;
  std::size_t echoes = 1;
  bool remissions = false;
  double farthest = 20;  ///< [m]
};

void PrintTo(const Model& model, std::ostream* out) { *out << model.name; }

/// By the data sheets. An LMS5xx measures to 80 m, which its telegrams encode in units of 2 mm.
const std::vector<Model> kModels{
    {.name = "LMS111", .remissions = true},
    {.name = "LMS141", .frequency = 50, .farthest = 40},
    {.name = "LMS151", .frequency = 25, .step = 0.25, .beams = 1081, .farthest = 50},
    {.name = "LMS151_two_echoes", .frequency = 25, .step = 0.25, .beams = 1081, .echoes = 2, .farthest = 50},
    {.name = "LMS153", .frequency = 25, .step = 0.5, .remissions = true, .farthest = 50},
    {.name = "LMS511",
     .frequency = 25,
     .first = -5,
     .step = 1.0 / 6,
     .beams = 1141,
     .remissions = true,
     .farthest = 80},
    {.name = "LMS511_pro",
     .frequency = 100,
     .first = -5,
     .step = 1,
     .beams = 191,
     .echoes = 5,
     .remissions = true,
     .farthest = 80},
};

class Models : public testing::TestWithParam<std::tuple<Model, ColaLanguage>> {};

Scan scan_of(const Model& model, unsigned number) {
  Scan scan{.serial_number = 4711,
            .telegram_counter = static_cast<std::uint16_t>(number),
            .scan_counter = static_cast<std::uint16_t>(number),
            .scan_time_us = 20'000 * number,
            .transmission_time_us = 20'000 * number + 3'000,
            .scan_frequency = model.frequency,
            .start_angle = model.first * kDegree,
            .angle_step = model.step * kDegree,
            .echoes = {},
            .encoders = {}};
  for (std::size_t n = 0; n < model.echoes; ++n) {
    Echo echo;
    for (std::size_t k = 0; k < model.beams; ++k) {  // whole units of 2 mm, the farthest among them
      const auto share =
          static_cast<double>((k * 7 + n) % model.beams) / static_cast<double>(model.beams - 1);
      echo.ranges.push_back(
          static_cast<float>(0.002 * std::round((0.1 + share * (model.farthest - 0.1)) / 0.002)));
      if (model.remissions) echo.remissions.push_back(static_cast<float>((k + number) % 255));
    }
    scan.echoes.push_back(std::move(echo));
  }
  return scan;
}

TEST_P(Models, GiveScanForScanWhatTheySent) {
  const auto& [model, language] = GetParam();
  constexpr unsigned kScans = 20;
  Emulator emulator(test::loopback_rig(1), {.speed = 0});
  LiveSource source(emulator.rig(), {.plate = false, .sick = {.language = language, .silence = 600}});
  for (unsigned number = 1; number <= kScans; ++number) {
    const auto sent = std::make_shared<const Scan>(scan_of(model, number));
    emulator.send(sent, [] { return false; });
    const auto item = source.next_within(test::kPatience);
    ASSERT_TRUE(item);
    const Scan& scan = *std::get<std::shared_ptr<const Scan>>(*item);
    EXPECT_EQ(scan.telegram_counter, number);
    EXPECT_EQ(scan.scan_frequency, model.frequency);
    EXPECT_NEAR(scan.start_angle, model.first * kDegree, 1e-9);
    EXPECT_NEAR(scan.angle_step, model.step * kDegree, 1e-9) << "the fraction, not what the telegram rounds";
    ASSERT_EQ(scan.echoes.size(), model.echoes);
    for (std::size_t n = 0; n < model.echoes; ++n) {
      EXPECT_THAT(scan.echoes[n].ranges,
                  testing::Pointwise(testing::FloatNear(1e-5F), sent->echoes[n].ranges));
      EXPECT_EQ(scan.echoes[n].remissions, sent->echoes[n].remissions);
    }
  }
  const auto statistics = source.close();
  const auto& laser = statistics.devices.at(0);
  EXPECT_EQ(laser.items, kScans);
  EXPECT_THAT(laser.losses.all(), testing::Each(testing::Pair(testing::_, 0)));
  EXPECT_EQ(test::count_beginning(laser.notes, "refused"), 0U);
}

INSTANTIATE_TEST_SUITE_P(Of, Models,
                         testing::Combine(testing::ValuesIn(kModels),
                                          testing::Values(ColaLanguage::A, ColaLanguage::B)),
                         [](const auto& tested) {
                           return std::get<0>(tested.param).name +
                                  (std::get<1>(tested.param) == ColaLanguage::A ? "_ColaA" : "_ColaB");
                         });

}  // namespace
}  // namespace crisp
