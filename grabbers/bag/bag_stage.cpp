// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <crisp/error.hpp>

#include "grabbers/bag/byte_cursor.hpp"

namespace crisp::bag {

/// The state of a run while its files are read.
struct BagStage::Run {
  Run(Outputs& outputs, Context& its_context, double max_gap)
      : out(outputs), context(its_context), routes(context.rig()), items(context.rig(), max_gap) {}

  Outputs& out;
  Context& context;
  BagRoutes routes;
  BagItems items;
  std::optional<std::int64_t> first_ns;
  std::vector<std::uint64_t> scans = std::vector<std::uint64_t>(context.rig().lasers.size());
  std::uint64_t angles = 0;
  std::map<std::string, std::string> topics;  ///< and their types, of all that the bag holds
};

void BagStage::describe(StageDescription<BagStage>& d) {
  d.name("grabber.bag").summary("reads scans and the plate's angles from a bag of ROS 1 or ROS 2");
  d.details(
      "ROS is not required. Supported bags are those of ROS 1 (.bag, chunks plain, bz2 or lz4), MCAP (chunks plain, lz4 or zstd) and ROS 2's in SQLite (.db3); a folder stands for the files in it, as ROS 2 writes them.\n\n"
      "Scans are sensor_msgs/LaserScan or MultiEchoLaserScan, or a message that holds one. On a topic that the rig names they may be the points of a 2D laser (sensor_msgs/PointCloud2, in the plane z = 0): each then has its own time, and a clock stage cannot align them. Points of a 3D laser with a rotating head are, as with `grabber.velodyne`, those of lasers with a fixed beam each: the rig names each by its `ring`, with `mount: -90deg`, and gives the plate the same topic, since the azimuth of the head is the plate's angle. The plate's angle is a joint of a sensor_msgs/JointState, the number of a std_msgs message, the rotation of a frame of tf, or a field of another message, a number or a quaternion. The rig names topics: `laser1: {topic: /tilt_scan, …}`, `plate: {topic: /joint_states, joint: laser_tilt_mount_joint}`, `plate: {topic: /encoder, unit: counts}`, `plate: {topic: /slice, field: stepAngle, unit: deg}`; without a name, the only topic of such a type is used. `crisp info BAG` lists topics, types and joints.\n\n"
      "A header's stamp is the firing time of beam 0, or the time of the angle; beams follow by the scan's time_increment. Scans and readings carry it as their device's time, and the time of receipt as the hub's, for a clock stage below. Where one computer stamped laser and plate, the stage's measurements can be placed without a clock stage. Angles are rounded to the plate's `counts_per_revolution`.");
  d.gives<Scan>().gives<PlateReading>().gives<PlateTrajectory>().gives<Measurements>();
  d.option("file", &BagStage::file_, "bag, or folder of its files").required();
  d.option(
       "actuator", &BagStage::actuator_,
       "motion of the plate during a scan whose message holds its angle: it moves, or it stands at that angle")
      .choices({{"moves", table::ActuatorMotion::moves}, {"stands", table::ActuatorMotion::stands}});
  d.option("max_gap", &BagStage::max_gap_, "longest silence of the angles to interpolate across")
      .unit("s")
      .range(1e-6, 1e6);
  d.option("begin", &BagStage::begin_, "start of the used part, after the first message's receipt")
      .unit("s")
      .at_least(0);
  d.option("duration", &BagStage::duration_, "duration of the used part; auto: to the end")
      .unit("s")
      .at_least(0);
}

void BagStage::check(const RunSettings& run) const { check_topics(run.rig); }

bool BagStage::is_requested(std::int64_t receipt_ns, Run& run) const {
  if (!run.first_ns) run.first_ns = receipt_ns;
  const double since_begin = 1e-9 * static_cast<double>(receipt_ns - *run.first_ns) - begin_;
  if ((begin_ == 0 || since_begin >= 0) && (!duration_ || since_begin < *duration_)) return true;
  run.context.count("messages outside of begin and duration");
  return false;
}

void BagStage::use(const BagRoute& route, const BagMessage& message, Run& run) const {
  std::optional<ScanMessage> scan;
  if (route.scans) scan = route.scans->decode(message.data);
  if (route.angles) {
    const auto angle = route.angles->decode(message.data);
    const bool stands = scan && actuator_ == table::ActuatorMotion::stands;
    const auto reading =
        angle ? run.items.add(*angle, message.receipt_ns, stands ? duration_of_beams(*scan) : 0)
              : std::nullopt;
    if (reading) run.out.give(*reading);
    run.angles += reading.has_value();
  }
  if (route.points) use_points(route, route.points->decode(message.data), run);
  if (!scan) return;
  const std::uint16_t laser = route.lasers.front();
  if (auto given = run.items.add(std::move(*scan), message.receipt_ns, laser)) {
    run.out.give(std::move(given));
    ++run.scans[laser];
  }
}

void BagStage::use_points(const BagRoute& route, const PointMessage& message, Run& run) {
  if (route.is_head) {
    if (!run.items.add_head(message, route.lasers)) return;
    for (const std::uint16_t laser : route.lasers) ++run.scans[laser];
    run.angles = run.items.head()->azimuths();
    if (auto piece = run.items.head()->take_piece()) std::move(*piece).give_to(run.out);
    return;
  }
  for (const std::uint16_t laser : route.lasers) run.scans[laser] += run.items.add(message, laser);
}

void BagStage::read(const std::filesystem::path& file, Run& run) const {
  constexpr std::uint64_t kReportEvery = 1000;
  run.context.reads(file);
  BagFile bag(file, [&run] { return run.context.interrupted(); });
  std::vector<BagRoute> routes;
  std::uint64_t messages = 0;
  while (const auto message = bag.reader().next()) {
    const auto& connections = bag.reader().connections();
    while (routes.size() < connections.size()) routes.push_back(run.routes.route(connections[routes.size()]));
    if (++messages % kReportEvery == 0) {
      if (run.context.interrupted()) return;
      run.context.progress(Progress{static_cast<double>(messages), 0, "messages", "reading the bag"});
    }
    const BagRoute& route = routes[message->connection];
    if ((route.lasers.empty() && !route.angles) || !is_requested(message->receipt_ns, run)) continue;
    try {
      use(route, *message, run);
    } catch (const BagDamage& damage) {
      run.context.count(damage.what);
    }
  }
  for (const auto& connection : bag.reader().connections()) run.topics[connection.topic] = connection.type;
  for (const auto& [what, n] : bag.reader().losses()) run.context.count(what, n);
}

void BagStage::report(const Run& run) const {
  Context& context = run.context;
  for (const auto& [what, n] : run.items.losses()) context.count(what, n);
  std::vector<std::string> topics;
  for (const auto& [topic, type] : run.topics) topics.push_back(fmt::format("{} ({})", topic, type));
  const std::string held =
      topics.empty() ? "it holds no topic" : fmt::format("its topics are {}", fmt::join(topics, ", "));
  if (run.angles == 0 && std::ranges::all_of(run.scans, [](std::uint64_t n) { return n == 0; }))
    throw Error(file_.string() + " holds no scan and no angle of the rig's devices",
                held + "; name them in the rig");
  for (const auto& topic : run.routes.missing())
    context.warn(fmt::format("the rig's topic {} is not in the bag; {}", topic, held));
  auto section = nlohmann::json::object();
  for (std::size_t i = 0; i < run.scans.size(); ++i) {
    const std::string& name = context.rig().lasers[i].name;
    context.print(fmt::format("{}: {} scans", name, run.scans[i]));
    section[name] = {{"scans", run.scans[i]}};
    if (run.scans[i] == 0) context.warn(fmt::format("the bag holds no scan of {}; {}", name, held));
  }
  context.print(fmt::format("{}: {} angles", context.rig().plate.name, run.angles));
  section[context.rig().plate.name] = {{"angles", run.angles}};
  context.report(section);
}

void BagStage::process(const Inputs&, Outputs& out, Context& context) {
  Run run(out, context, max_gap_);
  for (const auto& file : files_of_bag(file_)) {
    read(file, run);
    if (context.interrupted()) return;
  }
  report(run);
  run.items.check();
  if (devices::RotatingHead* head = run.items.head(); head && head->azimuths() > 1)
    head->take_rest().give_to(out);
  if (!run.items.has_trajectory()) return;
  out.give(run.items.trajectory());
  run.items.for_each_measured([&](std::shared_ptr<const Measurements> beams) { out.give(std::move(beams)); });
}

}  // namespace crisp::bag
