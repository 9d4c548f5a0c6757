// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plugins/report/encoded_cloud.hpp"

namespace crisp::report {

/// A plot that a stage drew.
struct ReportPlot {
  std::string name;  ///< "laser1_stamps"
  std::string svg;
};

/// Content of a report's page. Null or empty parts have no section.
struct PageContent {  // NOLINT(bugprone-exception-escape): moving JSON checks what it holds
  std::string title;
  nlohmann::ordered_json data;  ///< what the page's scripts read: summary, calibration, findings, motion …
  std::vector<ReportPlot> plots;
  std::optional<EncodedCloud> cloud;
};

/// JSON that may stand inside a <script> element, whatever its texts hold: every < is written as \u003c.
std::string script_json(const nlohmann::ordered_json& json);

/// Text that may stand in an element or in an attribute between double quotes.
std::string html_text(const std::string& text);

/// One self-contained page: it loads nothing, and its Content-Security-Policy has the browser refuse whatever
/// would, and every script but its own.
std::string page_html(const PageContent& content);

}  // namespace crisp::report
