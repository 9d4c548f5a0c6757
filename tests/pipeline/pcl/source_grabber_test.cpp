// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <chrono>
#include <future>
#include <stdexcept>

#include <crisp/source_grabber.hpp>

#include "pipeline/pcl/paced_source.hpp"

namespace crisp {
namespace {

using namespace crisp::pcl_grabber;
using testing::ElementsAre;

/// Scans 20 ms apart with a reading behind each; then the end, an error, or waiting for ever.
class ToySource : public ItemSource {
 public:
  enum class Ending { End, Error, Wait };
  ToySource(int scans, Ending ending) : scans_(scans), ending_(ending) {}

  std::optional<HubItem> next() override {
    if (given_ < 2 * scans_) {
      const int k = given_++ / 2;
      const auto time = 1'000'000'000 + k * std::int64_t{20'000'000};
      if (given_ % 2 == 0) return PlateReading{.sequence = static_cast<std::uint16_t>(k), .receipt_ns = time};
      Scan scan{.scan_counter = static_cast<std::uint16_t>(k), .receipt_ns = time};
      return std::make_shared<const Scan>(scan);
    }
    if (ending_ == Ending::Error) throw std::runtime_error("the cable was pulled");
    if (ending_ == Ending::Wait) interrupted_.get_future().wait();
    return {};
  }
  void interrupt() override {
    if (ending_ == Ending::Wait) interrupted_.set_value();
  }

 private:
  int scans_, given_ = 0;
  Ending ending_;
  std::promise<void> interrupted_;
};

SourceGrabber::Open toy(int scans, ToySource::Ending ending = ToySource::Ending::End) {
  return [=] { return std::make_unique<ToySource>(scans, ending); };
}

void on_scan(SourceGrabber& grabber, std::function<void(const Scan&)> callback) {
  grabber.registerCallback(std::function<SourceGrabber::ScanCallback>(
      [callback = std::move(callback)](const std::shared_ptr<const Scan>& scan) { callback(*scan); }));
}

TEST(SourceGrabber, CallsBackInOrderAndEndsByItself) {
  SourceGrabber grabber("toy", toy(3));
  std::vector<int> order;
  on_scan(grabber, [&](const Scan& scan) { order.push_back(scan.scan_counter); });
  grabber.registerCallback(std::function<SourceGrabber::ReadingCallback>(
      [&](const PlateReading& r) { order.push_back(100 + r.sequence); }));
  EXPECT_FALSE(grabber.isRunning());
  grabber.start();
  grabber.wait();
  EXPECT_FALSE(grabber.isRunning());
  EXPECT_THAT(order, ElementsAre(0, 100, 1, 101, 2, 102));
  EXPECT_FLOAT_EQ(grabber.getFramesPerSecond(), 50);
  EXPECT_EQ(grabber.getName(), "toy");
  EXPECT_FALSE(grabber.error());
  grabber.start();
  grabber.wait();
  EXPECT_EQ(order.size(), 12U) << "start() begins anew";
}

TEST(SourceGrabber, IsAPclGrabberLikeAnyOther) {
  SourceGrabber toy_grabber("toy", toy(1));
  ::pcl::Grabber& grabber = toy_grabber;
  EXPECT_TRUE(grabber.providesCallback<SourceGrabber::ScanCallback>());
  EXPECT_TRUE(grabber.providesCallback<SourceGrabber::ReadingCallback>());
  EXPECT_FALSE(grabber.providesCallback<void(int)>());
  EXPECT_THROW(grabber.registerCallback(std::function<void(int)>([](int) {})), ::pcl::IOException);
}

TEST(SourceGrabber, StopsASourceThatWaits) {
  SourceGrabber grabber("toy", toy(2, ToySource::Ending::Wait));
  std::promise<void> second;
  on_scan(grabber, [&](const Scan& scan) {
    if (scan.scan_counter == 1) second.set_value();
  });
  grabber.start();
  second.get_future().wait();
  EXPECT_TRUE(grabber.isRunning());
  grabber.stop();  // would hang if it could not
  EXPECT_FALSE(grabber.isRunning());
  grabber.stop();
}

TEST(SourceGrabber, LetsAThreadWaitWhileAnotherStops) {
  SourceGrabber grabber("toy", toy(0, ToySource::Ending::Wait));
  grabber.start();
  auto waiting = std::async(std::launch::async, [&] { grabber.wait(); });
  grabber.stop();
  waiting.get();
  EXPECT_FALSE(grabber.isRunning());
}

TEST(SourceGrabber, CanBeStoppedFromACallback) {
  SourceGrabber grabber("toy", toy(1000));
  int calls = 0;
  on_scan(grabber, [&](const Scan&) {
    if (++calls == 5) grabber.stop();
  });
  grabber.start();
  grabber.wait();
  EXPECT_EQ(calls, 5);
}

TEST(SourceGrabber, EndsWhenItIsDestroyed) {
  auto grabber = std::make_unique<SourceGrabber>("toy", toy(3, ToySource::Ending::Wait));
  grabber->start();
  grabber.reset();  // would hang if it did not
}

TEST(SourceGrabber, KeepsTheErrorThatEndedIt) {
  SourceGrabber grabber("toy", toy(3, ToySource::Ending::Error));
  grabber.start();
  grabber.wait();
  ASSERT_TRUE(grabber.error());
  EXPECT_THROW(std::rethrow_exception(grabber.error()), std::runtime_error);
  SourceGrabber throwing("toy", toy(3));
  on_scan(throwing, [](const Scan&) { throw std::logic_error("a callback's mistake"); });
  throwing.start();
  throwing.wait();
  EXPECT_TRUE(throwing.error());
}

TEST(SourceGrabber, ThrowsFromStartWhatOpeningThrows) {
  SourceGrabber grabber("toy",
                        []() -> std::unique_ptr<ItemSource> { throw std::runtime_error("no such file"); });
  EXPECT_THROW(grabber.start(), std::runtime_error);
  EXPECT_FALSE(grabber.isRunning());
}

TEST(PacedSource, GivesNothingBeforeItsTime) {
  PacedSource source(std::make_unique<ToySource>(5, ToySource::Ending::End), 2);
  const auto begin = std::chrono::steady_clock::now();
  int items = 0;
  while (source.next()) ++items;
  EXPECT_EQ(items, 10);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(40))
      << "80 ms at twice the speed";
}

TEST(PacedSource, ReturnsFromAPauseWhenInterrupted) {
  PacedSource source(std::make_unique<ToySource>(2, ToySource::Ending::End), 1e-9);  // the next in years
  EXPECT_TRUE(source.next());
  EXPECT_TRUE(source.next());
  auto third = std::async(std::launch::async, [&] { return source.next().has_value(); });
  source.interrupt();
  EXPECT_FALSE(third.get());
}

}  // namespace
}  // namespace crisp
