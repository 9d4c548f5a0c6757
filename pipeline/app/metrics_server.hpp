// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace crisp::app {

/// Answers `GET /metrics` over HTTP with a text, at 127.0.0.1 alone, in a thread of its own.
class MetricsServer {
 public:
  using Text = std::function<std::string()>;

  /// @param port  0: any that is free
  /// @param text  called in the server's thread for the metrics' text
  /// @throws Error if the port cannot be listened at
  MetricsServer(std::uint16_t port, Text text);
  ~MetricsServer();
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;

  std::uint16_t port() const;

 private:
  struct Server;
  std::unique_ptr<Server> server_;
};

}  // namespace crisp::app
