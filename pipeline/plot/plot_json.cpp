// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/plot/plot_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "pipeline/files/json_text.hpp"

namespace crisp::plot {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.5g}", value).c_str(), nullptr);
}

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

Json series_json(const PlotSeries& series) {
  Json json{
      {"name", series.name}, {"x", numbers(series.x)}, {"y", numbers(series.y)}, {"joined", series.joined}};
  if (!series.error.empty()) json["error"] = numbers(series.error);
  return json;
}

}  // namespace

std::string plot_json(const Plot& plot) {
  Json json{{"title", plot.title},     {"x_label", plot.x_label},
            {"y_label", plot.y_label}, {"logarithmic", plot.y_scale == PlotScale::logarithmic},
            {"series", Json::array()}, {"kinds", Json::array()},
            {"marks", Json::array()}};
  for (const PlotSeries& series : plot.series) json["series"].push_back(series_json(series));
  for (const PlotKind& kind : plot.kinds)
    json["kinds"].push_back({{"at", number(kind.at)}, {"name", kind.name}});
  for (const PlotMark& mark : plot.marks) {
    json["marks"].push_back({{"at", number(mark.at)}, {"around", number(mark.around)}, {"name", mark.name}});
  }
  return files::json_text(json);
}

}  // namespace crisp::plot
