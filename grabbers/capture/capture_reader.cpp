// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <map>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <crisp/capture_reader.hpp>

#include "grabbers/capture/dissect.hpp"
#include "grabbers/capture/flow_decoder.hpp"
#include "grabbers/capture/fragments.hpp"
#include "grabbers/capture/ordered_capture.hpp"
#include "grabbers/capture/reorder_buffer.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp {
namespace {

using capture::FlowDecoder;

constexpr std::size_t kMaxFlows = 4096;
constexpr std::string_view kPlateMark = "$PPLT,";

}  // namespace

struct CaptureReader::Traffic {
  Traffic(const std::filesystem::path& path, devices::DeviceRegistry all, const CaptureSettings& how)
      : file(path, [this, stop = how.interrupted] { return interrupted || (stop && stop()); }),
        devices(std::move(all)),
        settings(how) {}

  std::atomic<bool> interrupted = false;
  capture::OrderedCapture file;
  devices::DeviceRegistry devices;
  CaptureSettings settings;
  capture::FragmentAssembler fragments;
  std::unordered_map<devices::FlowKey, std::unique_ptr<FlowDecoder>> flows;
  std::vector<FlowDecoder*> rig_flows;
  capture::ReorderBuffer<HubItem> merge;
  FlowDecoder::Give give = [this](HubItem item) {
    const std::int64_t time_ns = receipt_ns(item);
    merge.push(time_ns, std::move(item));
  };
  CaptureStatistics totals;
  std::map<std::uint32_t, std::uint64_t> link_types;  ///< packets
  std::int64_t newest_ns = 0, given_ns = 0;
  bool ended = false;

  bool read_packet();
  void take_ip(const devices::IpPacket& ip, std::int64_t time_ns);
  FlowDecoder* find_flow(const devices::TransportPacket& packet);
  void forget_flows();
  std::int64_t limit_ns();
  void finish();
  std::optional<HubItem> next();
};

/// False at the end of the capture.
bool CaptureReader::Traffic::read_packet() {
  const auto* packet = file.next();
  if (packet == nullptr) return false;
  const auto found = capture::dissect_ip(*packet);
  const auto* sent = std::get_if<devices::IpPacket>(&found);
  const std::int64_t time_ns = packet->time_ns + (sent == nullptr ? 0 : file.shift_of(*sent));
  newest_ns = totals.packets == 0 ? time_ns : std::max(newest_ns, time_ns);
  totals.first_ns = totals.packets == 0 ? time_ns : std::min(totals.first_ns, time_ns);
  totals.last_ns = newest_ns;
  ++totals.packets;
  totals.bytes += packet->bytes.size();
  ++link_types[packet->link_type];
  if (const auto* reason = std::get_if<capture::NoIp>(&found)) {
    if (*reason == capture::NoIp::Damaged) totals.losses.add("packets with damaged headers");
    if (*reason == capture::NoIp::UnknownLinkType) totals.losses.add("packets of unsupported link types");
    return true;
  }
  const devices::IpPacket& ip = *sent;
  if (!ip.is_fragment()) {
    take_ip(ip, time_ns);
  } else if (const auto whole = fragments.take(ip, time_ns)) {
    take_ip(*whole, time_ns);
  }
  return true;
}

void CaptureReader::Traffic::take_ip(const devices::IpPacket& ip, std::int64_t time_ns) {
  bool damaged = false;
  const auto packet = capture::dissect_transport(ip, damaged);
  if (damaged) totals.losses.add("packets with damaged headers");
  if (!packet) return;
  if (packet->missing > 0) ++totals.truncated;
  if (auto* flow = find_flow(*packet)) flow->take(*packet, time_ns);
}

FlowDecoder* CaptureReader::Traffic::find_flow(const devices::TransportPacket& packet) {
  const auto found = flows.find(packet.key);
  if (found != flows.end()) return found->second.get();
  auto* known = devices.known(packet.key);
  const bool has_content = !packet.payload.empty() || packet.syn;
  const bool like_a_plate = wire::as_text(packet.payload).find(kPlateMark) != std::string_view::npos;
  if (known == nullptr &&
      (!has_content || (packet.key.transport == devices::Transport::Udp && !like_a_plate)))
    return nullptr;
  if (flows.size() >= kMaxFlows) forget_flows();
  auto flow = std::make_unique<FlowDecoder>(packet.key, devices, known, settings, give);
  if (known != nullptr) rig_flows.push_back(flow.get());
  return flows.emplace(packet.key, std::move(flow)).first->second.get();
}

/// Forgets the older half of all flows; one that goes on is taken up again.
void CaptureReader::Traffic::forget_flows() {
  std::vector<std::int64_t> ages;
  for (const auto& [key, flow] : flows) ages.push_back(flow->last_ns());
  const std::int64_t middle = statistics::median_in_place(ages);
  const auto old = [&](const FlowDecoder& flow) { return flow.last_ns() <= middle; };
  std::erase_if(rig_flows, [&](const FlowDecoder* flow) { return old(*flow); });
  for (auto& [key, flow] : flows) {
    if (old(*flow)) flow->finish();
  }
  std::erase_if(flows, [&](const auto& entry) { return old(*entry.second); });
}

/// Items received before this are complete and in order.
std::int64_t CaptureReader::Traffic::limit_ns() {
  auto limit = newest_ns - capture::kMaxReordering;
  const auto longest = static_cast<std::int64_t>(1e9 * settings.max_wait);
  for (auto* flow : rig_flows) {
    flow->expire(newest_ns);
    if (const auto since = flow->waiting_since(newest_ns - longest)) limit = std::min(limit, *since);
  }
  return limit;
}

void CaptureReader::Traffic::finish() {
  ended = true;
  fragments.finish();
  std::vector<std::pair<devices::FlowKey, FlowDecoder*>>
      ordered;  // so that what ends gives comes in the same order everywhere
  for (auto& [key, flow] : flows) ordered.emplace_back(key, flow.get());
  std::sort(ordered.begin(), ordered.end());
  for (auto& [key, flow] : ordered) flow->finish();
  rig_flows.clear();
  flows.clear();
}

std::optional<HubItem> CaptureReader::Traffic::next() {
  while (!interrupted) {
    if (ended ? !merge.empty()
              : merge.has(newest_ns - capture::kMaxReordering)) {  // no limit is later than this
      if (auto next = ended ? merge.pop() : merge.pop(limit_ns())) {
        if (next->time_ns < given_ns)
          totals.notes.add("items out of order, since the hub's clock stepped back");
        given_ns = next->time_ns;
        return std::move(next->item);
      }
    }
    if (ended) return {};
    if (!read_packet()) finish();
  }
  return {};
}

CaptureReader::CaptureReader(const std::filesystem::path& file, const Rig& rig,
                             const CaptureSettings& settings)
    : traffic_(std::make_unique<Traffic>(file, devices::DeviceRegistry(rig), settings)) {}

CaptureReader::CaptureReader(std::unique_ptr<Traffic> traffic) : traffic_(std::move(traffic)) {}
CaptureReader::~CaptureReader() = default;
CaptureReader::CaptureReader(CaptureReader&&) noexcept = default;
CaptureReader& CaptureReader::operator=(CaptureReader&&) noexcept = default;

std::optional<HubItem> CaptureReader::next() { return traffic_->next(); }

void CaptureReader::interrupt() { traffic_->interrupted = true; }

std::int64_t CaptureReader::first_ns() const { return traffic_->totals.first_ns; }

double CaptureReader::progress() const {
  const auto size = traffic_->file.size();
  return size == 0 ? 0
                   : std::min(1.0, static_cast<double>(traffic_->file.offset()) / static_cast<double>(size));
}

CaptureStatistics CaptureReader::statistics() const {
  auto statistics = traffic_->totals;
  for (const auto& [type, n] : traffic_->link_types)
    statistics.link_types.add(capture::link_type_name(type), n);
  statistics.file_bytes = traffic_->file.offset();
  statistics.remarks = traffic_->file.remarks();
  statistics.losses.add(traffic_->file.losses());
  statistics.notes.add(traffic_->file.notes());
  statistics.losses.add(traffic_->fragments.losses());
  statistics.devices = traffic_->devices.statistics();
  statistics.pauses = traffic_->devices.pauses().count();
  statistics.paused = traffic_->devices.pauses().seconds();
  return statistics;
}

void check_addresses(const Rig& rig) { const devices::DeviceRegistry devices(rig); }

CaptureStatistics inspect_capture(const std::filesystem::path& file, const CaptureSettings& settings,
                                  const RigPlate& plate) {
  devices::DeviceRegistry devices;
  if (plate.line) devices.add(plate);
  CaptureReader reader(std::make_unique<CaptureReader::Traffic>(file, std::move(devices), settings));
  while (reader.next()) {
  }
  return reader.statistics();
}

}  // namespace crisp
