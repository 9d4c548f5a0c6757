// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <sstream>

#include <crisp/error.hpp>

#include "pipeline/app/metrics_server.hpp"
#include "pipeline/app/progress.hpp"
#include "pipeline/app/status_board.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using testing::HasSubstr;
using testing::StartsWith;

TEST(StatusBoard, ShowsEachStagesLastStatusInThePipelinesOrder) {
  StatusBoard board({"grabber.live", "clock.online", "calibrate.watch"});
  board.set_status("clock.online",
                   {.line = "skew +4.5 ppm", .gauges = {{"rate_hertz", 1}, {"resets_total", 2}}});
  board.set_status("grabber.live", {.line = "laser1 50.0 Hz", .gauges = {{"rate_hertz", 50, "laser1"}}});
  board.set_status("grabber.live", {.line = "laser1 49.9 Hz", .gauges = {{"rate_hertz", 49.9, "laser1"}}});
  EXPECT_EQ(board.line(), "laser1 49.9 Hz | skew +4.5 ppm");
  EXPECT_EQ(board.prometheus(),
            "# TYPE crisp_rate_hertz gauge\n"
            "crisp_rate_hertz{stage=\"clock.online\"} 1\n"
            "crisp_rate_hertz{stage=\"grabber.live\",device=\"laser1\"} 49.9\n"
            "# TYPE crisp_resets_total counter\n"
            "crisp_resets_total{stage=\"clock.online\"} 2\n");
}

/// What a server answers before it closes the connection.
std::string get(std::uint16_t port, const std::string& request) {
  boost::asio::io_context context;
  boost::asio::ip::tcp::socket socket(context);
  socket.connect({boost::asio::ip::address_v4::loopback(), port});
  boost::asio::write(socket, boost::asio::buffer(request));
  std::string answer;
  boost::system::error_code end;
  boost::asio::read(socket, boost::asio::dynamic_buffer(answer), end);
  return answer;
}

TEST(MetricsServer, AnswersAtItsOnePlace) {
  int requested = 0;
  const MetricsServer server(0, [&] { return "crisp_requests " + std::to_string(++requested) + "\n"; });
  const std::string metrics = get(server.port(), "GET /metrics HTTP/1.0\r\n\r\n");
  EXPECT_THAT(metrics, StartsWith("HTTP/1.0 200 OK"));
  EXPECT_THAT(metrics, HasSubstr("text/plain; version=0.0.4"));
  EXPECT_THAT(metrics, HasSubstr("\r\n\r\ncrisp_requests 1\n"));
  EXPECT_THAT(get(server.port(), "GET / HTTP/1.0\r\n\r\n"), StartsWith("HTTP/1.0 404"));
  EXPECT_THAT(get(server.port(), "POST /metrics HTTP/1.0\r\ncontent-length: 0\r\n\r\n"),
              StartsWith("HTTP/1.0 404"));
}

TEST(MetricsServer, StandsNonsenseAndRequestsWithoutEnd) {
  const MetricsServer server(0, [] { return std::string("crisp_requests 1\n"); });
  EXPECT_EQ(get(server.port(), std::string(1000, '\x02')), "");
  EXPECT_EQ(get(server.port(), "GET /metrics HTTP/1.0\r\nx: " + std::string(17'000, 'x')), "");
  EXPECT_THAT(get(server.port(), "GET /metrics HTTP/1.0\r\n\r\n"), HasSubstr("crisp_requests 1"));
}

TEST(MetricsServer, RefusesAPortThatIsTaken) {
  const MetricsServer server(0, [] { return std::string(); });
  EXPECT_THROW(MetricsServer(server.port(), [] { return std::string(); }), Error);
}

TEST(ProgressPrinter, RefreshesAStatusOnATerminalAndLogsItElsewhere) {
  for (const bool terminal : {true, false}) {
    std::ostringstream out;
    double now = 0;
    {
      ProgressPrinter printer(
          out, terminal, [&] { return now; }, 8);
      for (now = 0; now < 25; now += 0.5) printer.show_status("0123456789");
    }
    const std::string shown = out.str();
    if (terminal) {
      EXPECT_EQ(shown.find('7'), std::string::npos) << "cut at the width";
      EXPECT_THAT(shown, StartsWith("\r\x1b[K0123456"));
      EXPECT_GT(shown.size(), 40 * 10U);
    } else {
      EXPECT_EQ(shown, "0123456789\n0123456789\n0123456789\n") << "at 0, 10 and 20 s";
    }
  }
}

TEST(ProgressPrinter, KeepsEventsOnATerminalWhereTheStatusIsRefreshed) {
  std::ostringstream out;
  double now = 0;
  {
    ProgressPrinter printer(
        out, true, [&] { return now; }, 80);
    printer.show_status("all is well");
    printer.log("laser1 fell silent");
    now = 1;
    printer.show_status("all is well");
  }
  EXPECT_EQ(out.str(), "\r\x1b[Kall is well\r\x1b[Klaser1 fell silent\n\r\x1b[Kall is well\r\x1b[K");
}

}  // namespace
}  // namespace crisp
