// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/page.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>

#include "pipeline/files/json_text.hpp"
#include "plugins/report/base64.hpp"
#include "plugins/report/page_assets.hpp"

namespace crisp::report {
namespace {

std::string replaced(const std::string& text, char what, std::string_view by) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (c == what)
      result += by;
    else
      result += c;
  }
  return result;
}

std::span<const unsigned char> bytes_of(std::string_view text) {
  return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

/// Hash of a script for a Content-Security-Policy.
std::string script_hash(std::string_view script) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  EVP_Digest(script.data(), script.size(), digest.data(), &size, EVP_sha256(), nullptr);
  return "'sha256-" + base64_of({digest.data(), size}) + "'";
}

std::string page_script() {
  std::string script = "'use strict';\n(() => {\n";
  for (const std::string_view part : kPageScripts) script += part;
  return script + "main();\n})();\n";
}

std::string with_plots(const PageContent& content) {
  auto data = content.data;
  data["title"] = content.title;
  data["plots"] = nlohmann::ordered_json::array();
  for (const ReportPlot& plot : content.plots) {
    data["plots"].push_back(
        {{"name", plot.name}, {"svg", "data:image/svg+xml;base64," + base64_of(bytes_of(plot.svg))}});
  }
  if (content.cloud) data["cloud"] = content.cloud->header;
  return script_json(data);
}

}  // namespace

std::string script_json(const nlohmann::ordered_json& json) {
  return replaced(files::json_text(json), '<', "\\u003c");
}

std::string html_text(const std::string& text) {
  std::string safe = replaced(text, '&', "&amp;");
  safe = replaced(safe, '<', "&lt;");
  safe = replaced(safe, '>', "&gt;");
  return replaced(safe, '"', "&quot;");
}

std::string page_html(const PageContent& content) {
  const std::string script = page_script();
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src {}; style-src 'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"crisp {}\">\n<title>{}</title>\n<style>\n{}</style>\n</head>\n"
      "<body>\n<noscript>This page needs JavaScript. It is all in the file: nothing is loaded.</noscript>\n"
      "<main id=\"page\"></main>\n",
      script_hash(script), CRISP_VERSION, html_text(content.title), kPageStyle);
  page += R"(<script type="application/json" id="report-data">)" + with_plots(content) + "</script>\n";
  if (content.cloud) {
    page += R"(<script type="text/plain" id="report-cloud">)";
    page += content.cloud->base64;
    page += "</script>\n";
  }
  return page + "<script>" + script + "</script>\n</body>\n</html>\n";
}

}  // namespace crisp::report
