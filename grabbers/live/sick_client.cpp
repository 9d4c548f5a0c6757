// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/sick_client.hpp"

#include <boost/asio/write.hpp>
#include <memory>
#include <utility>

#include "grabbers/devices/framing_losses.hpp"

namespace crisp::live {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::uint16_t kScanPort = 2112;
constexpr std::size_t kPiece = 64 * 1024;  // [bytes] read at once
constexpr double kPoll = 0.2;              // [s] between questions whether the laser is ready
constexpr double kFarewell = 0.05;         // [s] for the answer to the last request
constexpr double kMotor = 60;              // [s] until it turns at another speed

ColaLanguage other(ColaLanguage language) {
  return language == ColaLanguage::A ? ColaLanguage::B : ColaLanguage::A;
}

}  // namespace

SickClient::SickClient(asio::io_context& context, devices::DeviceLog& log, const Address& address,
                       SickSettings settings, GiveItem give, HubClock clock)
    : context_(context),
      log_(log),
      endpoint_(ip_of(address), address.port == 0 ? kScanPort : address.port),
      settings_(std::move(settings)),
      give_(std::move(give)),
      clock_(std::move(clock)),
      socket_(context),
      alarm_(context),
      back_off_(settings_.max_reconnect_delay),
      buffer_(kPiece),
      language_(settings_.language) {}

void SickClient::start() { connect(); }

void SickClient::connect() {
  ++connection_;
  socket_ = tcp::socket(context_);
  socket_.async_connect(endpoint_, [this, mine = connection_](const error_code& failure) {
    if (mine != connection_) return;
    if (failure) return fail(failure.message());
    begin_dialogue();
  });
  alarm_.set(settings_.reply_timeout, [this] { not_answered(); });
}

void SickClient::begin_dialogue() {
  framer_ = {};
  languages_tried_ = 1;
  refusals_reported_ = 0;
  compared_ = settings_.configuration.is_empty();
  dialogue_.emplace(language_, settings_.start, settings_.configuration);
  read();
  request_scan();
}

void SickClient::request_scan() {
  send(dialogue_->request());
  alarm_.set(dialogue_->is_slow() ? kMotor : settings_.reply_timeout, [this] { not_answered(); });
}

void SickClient::not_answered() {
  if (!dialogue_) return fail("the connection was not answered");
  if (dialogue_->step() != SickStep::DetectLanguage || languages_tried_ == 2) {
    return fail("a request was not answered");
  }
  ++languages_tried_;
  language_ = other(language_);
  dialogue_.emplace(language_, settings_.start, settings_.configuration);
  request_scan();
}

void SickClient::read() {
  socket_.async_read_some(asio::buffer(buffer_),
                          [this, mine = connection_](const error_code& failure, std::size_t bytes) {
                            if (mine != connection_) return;
                            if (failure) return fail(failure.message());
                            take(bytes);
                            if (mine == connection_) read();
                          });
}

void SickClient::take(std::size_t bytes) {
  const auto sink = [this](const wire::ColaFrame& frame) { take(frame); };
  framer_.feed(wire::ByteView(buffer_).first(bytes), clock_(), sink);
  if (over_) fail(*std::exchange(over_, {}));
}

void SickClient::take(const wire::ColaFrame& frame) {
  const bool came = !stopping_ && take_scan(frame);
  const auto telegram = wire::parse_cola(frame.payload, frame.language);
  if (!telegram || over_) return;
  if (stopping_) {
    if (telegram->command == "sEA") over_ = "farewell";
  } else if (dialogue_->step() != SickStep::Scans) {
    proceed(dialogue_->take(*telegram));
  } else if (came) {
    await_scan();
  }
}

bool SickClient::take_scan(const wire::ColaFrame& frame) {
  auto scan = log_.take(frame, settings_.encoder_widths);
  if (!scan) return false;
  if (!compared_ && dialogue_ && dialogue_->step() == SickStep::Scans) note_difference(*scan);
  give_(std::move(scan));
  return true;
}

void SickClient::note_difference(const Scan& scan) {
  compared_ = true;
  const std::string found = difference(settings_.configuration, scan);
  if (!found.empty()) log_.note("connections whose scans were not as configured: " + found);
}

void SickClient::proceed(SickDialogue::Effect effect) {
  for (; refusals_reported_ < dialogue_->refusals().size(); ++refusals_reported_) {
    log_.note("refused by the laser: " + dialogue_->refusals()[refusals_reported_]);
  }
  if (effect == SickDialogue::Effect::RequestLater) return alarm_.set(kPoll, [this] { request_scan(); });
  if (effect == SickDialogue::Effect::None) return;
  if (dialogue_->step() == SickStep::Refused) {
    over_ = "the laser refused to send scans";
    return;
  }
  if (dialogue_->step() != SickStep::Scans) return request_scan();
  back_off_.reset();
  await_scan();
}

void SickClient::await_scan() {
  alarm_.set(settings_.silence, [this] { fail("no scan came"); });
}

void SickClient::fail(const std::string& reason) {
  close();
  if (stopping_) return;
  log_.note("connections that failed: " + reason);
  alarm_.set(back_off_.next(), [this] { connect(); });
}

void SickClient::close() {
  framer_.gap([this](const wire::ColaFrame& frame) {
    if (!stopping_) take_scan(frame);
  });
  devices::note_framing(framer_.counts(), log_);
  framer_ = {};
  dialogue_.reset();
  ++connection_;
  alarm_.cancel();
  error_code ignored;
  socket_.close(ignored);
}

void SickClient::stop() {
  if (stopping_) return;
  stopping_ = true;
  if (!dialogue_ || dialogue_->step() != SickStep::Scans) return close();
  send(unsubscribe_request(language_));
  alarm_.set(kFarewell, [this] { close(); });
}

void SickClient::send(const wire::Bytes& telegram) {
  const auto kept = std::make_shared<const wire::Bytes>(telegram);
  asio::async_write(socket_, asio::buffer(*kept),
                    [this, kept, mine = connection_](const error_code& failure, std::size_t) {
                      if (failure && mine == connection_) fail(failure.message());
                    });
}

}  // namespace crisp::live
