// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/metrics_server.hpp"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <thread>
#include <utility>

#include <crisp/error.hpp>

namespace crisp::app {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

constexpr std::chrono::seconds kPatience{10};
constexpr std::size_t kLongestRequest = 16 * 1024;  // [bytes]

/// One client; a request that does not come, or is too long, ends it.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket socket, const MetricsServer::Text& text)
      : stream_(std::move(socket)), buffer_(kLongestRequest), text_(text) {}

  void read() {
    request_ = {};
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, request_,
                     [self = shared_from_this()](const beast::error_code& failure, std::size_t) {
                       if (!failure) self->answer();
                     });
  }

 private:
  void answer() {
    const bool known = request_.method() == http::verb::get && request_.target() == "/metrics";
    response_ = {known ? http::status::ok : http::status::not_found, request_.version()};
    response_.set(http::field::content_type, "text/plain; version=0.0.4; charset=utf-8");
    response_.keep_alive(request_.keep_alive());
    response_.body() = known ? text_() : "the metrics are at /metrics\n";
    response_.prepare_payload();
    http::async_write(stream_, response_,
                      [self = shared_from_this()](const beast::error_code& failure, std::size_t) {
                        if (!failure && self->response_.keep_alive()) self->read();
                      });
  }

  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  const MetricsServer::Text& text_;  ///< of the server, which outlives its sessions
  http::request<http::string_body> request_;
  http::response<http::string_body> response_;
};

}  // namespace

struct MetricsServer::Server {
  Server(std::uint16_t port, Text what) : text(std::move(what)), acceptor(context) {
    const tcp::endpoint at(asio::ip::address_v4::loopback(), port);
    boost::system::error_code failure;
    acceptor.open(at.protocol(), failure);
    if (!failure) acceptor.set_option(tcp::acceptor::reuse_address(true), failure);
    if (!failure) acceptor.bind(at, failure);
    if (!failure) acceptor.listen(tcp::acceptor::max_listen_connections, failure);
    if (failure) {
      throw Error(fmt::format("cannot serve metrics at 127.0.0.1:{}: {}", port, failure.message()),
                  "give a port that no other program uses");
    }
    accept();
    thread = std::thread([this] { context.run(); });
  }

  void accept() {
    acceptor.async_accept([this](const boost::system::error_code& failure, tcp::socket socket) {
      if (!failure) std::make_shared<HttpSession>(std::move(socket), text)->read();
      if (acceptor.is_open()) accept();
    });
  }

  Text text;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  std::thread thread;
};

MetricsServer::MetricsServer(std::uint16_t port, Text text)
    : server_(std::make_unique<Server>(port, std::move(text))) {}

MetricsServer::~MetricsServer() {
  server_->context.stop();
  server_->thread.join();
}

std::uint16_t MetricsServer::port() const { return server_->acceptor.local_endpoint().port(); }

}  // namespace crisp::app
