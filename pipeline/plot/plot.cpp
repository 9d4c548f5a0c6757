// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/plot/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace crisp {
namespace {

constexpr double kWidth = 640, kHeight = 400;  // [pixels] of a plot
constexpr std::size_t kInARow = 2;
constexpr double kLeft = 70, kRight = 20, kTop = 36, kBottom = 50;  // [pixels] around the curves
constexpr std::array<const char*, 5> kColours = {"#1f5fbf", "#d9731a", "#2a8f3c", "#8a3fa8", "#777777"};

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '&')
      safe += "&amp;";
    else
      safe += c;
  }
  return safe;
}

/// From a quantity to pixels, with marks at round values.
class PlotAxis {
 public:
  PlotAxis(double least, double most, double first_pixel, double last_pixel)
      : first_pixel_(first_pixel), last_pixel_(last_pixel) {
    if (!(most > least)) most = least + 1;
    constexpr double kRoom = 0.04;
    least_ = least - kRoom * (most - least);
    most_ = most + kRoom * (most - least);
  }
  double pixel(double value) const {
    return first_pixel_ + (value - least_) / (most_ - least_) * (last_pixel_ - first_pixel_);
  }
  std::vector<double> marks() const {
    constexpr double kMarks = 6;
    const double rough = (most_ - least_) / kMarks;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    double step = 10 * power;
    for (const double nice : {1.0, 2.0, 5.0}) {
      if (nice * power >= rough) {
        step = nice * power;
        break;
      }
    }
    std::vector<double> all;
    const auto first = static_cast<long>(std::ceil(least_ / step)),
               last = static_cast<long>(std::floor(most_ / step));
    for (long i = first; i <= last; ++i) all.push_back(static_cast<double>(i) * step);
    return all;
  }

 private:
  double least_ = 0, most_ = 1;
  double first_pixel_, last_pixel_;
};

double error_at(const PlotSeries& series, std::size_t i) {
  return i < series.error.size() && std::isfinite(series.error[i]) ? series.error[i] : 0;
}

PlotAxis axis_of(const Plot& plot, bool along_x) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const auto& series : plot.series) {
    const auto& values = along_x ? series.x : series.y;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) continue;
      const double around = along_x ? 0 : error_at(series, i);
      least = std::min(least, values[i] - around);
      most = std::max(most, values[i] + around);
    }
  }
  if (!std::isfinite(least)) least = 0, most = 1;
  return along_x ? PlotAxis(least, most, kLeft, kWidth - kRight)
                 : PlotAxis(least, most, kHeight - kBottom, kTop);
}

std::string text_at(double x, double y, const char* anchor, const std::string& text, const char* more = "") {
  return fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                     escaped(text));
}

std::string frame(const Plot& plot, const PlotAxis& x, const PlotAxis& y) {
  std::string svg;
  for (const double mark : x.marks()) {
    svg += fmt::format("<path d=\"M{0:.1f} {1:.0f}V{2:.0f}\" stroke=\"#ddd\"/>\n", x.pixel(mark), kTop,
                       kHeight - kBottom);
    svg += text_at(x.pixel(mark), kHeight - kBottom + 16, "middle", fmt::format("{:.6g}", mark));
  }
  for (const double mark : y.marks()) {
    svg += fmt::format("<path d=\"M{0:.0f} {1:.1f}H{2:.0f}\" stroke=\"#ddd\"/>\n", kLeft, y.pixel(mark),
                       kWidth - kRight);
    svg += text_at(kLeft - 6, y.pixel(mark) + 4, "end", fmt::format("{:.6g}", mark));
  }
  svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#333\"/>\n",
                     kLeft, kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  svg += text_at(kWidth / 2, 22, "middle", plot.title, " font-size=\"14\"");
  svg += text_at(kWidth / 2, kHeight - 12, "middle", plot.x_label);
  svg += text_at(-kHeight / 2, 16, "middle", plot.y_label, " transform=\"rotate(-90)\"");
  return svg;
}

std::string curve(const PlotSeries& series, const char* colour, const PlotAxis& x, const PlotAxis& y) {
  std::string path;
  std::string dots;
  std::string bars;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
    const double px = x.pixel(series.x[i]), py = y.pixel(series.y[i]);
    const double around = error_at(series, i);
    if (around > 0) {
      bars += fmt::format("M{:.1f} {:.1f}V{:.1f}", px, y.pixel(series.y[i] - around),
                          y.pixel(series.y[i] + around));
    }
    if (series.joined)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
    else
      dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\" fill=\"{}\"/>\n", px, py, colour);
  }
  const auto line = [colour](const std::string& way, double width) {
    if (way.empty()) return std::string();
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n", way, colour,
                       width);
  };
  return line(path, 1.6) + line(bars, 0.8) + dots;
}

std::string drawn(const Plot& plot) {
  const PlotAxis x = axis_of(plot, true);
  const PlotAxis y = axis_of(plot, false);
  std::string svg = frame(plot, x, y);
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const char* colour = kColours[i % kColours.size()];
    svg += curve(plot.series[i], colour, x, y);
    const double line = kTop + 16 + 15 * static_cast<double>(i);
    const auto style =
        fmt::format(R"( fill="{}" stroke="white" stroke-width="3" paint-order="stroke")", colour);
    svg += text_at(kWidth - kRight - 8, line, "end", plot.series[i].name, style.c_str());
  }
  return svg;
}

}  // namespace

std::string as_svg(const std::vector<Plot>& plots) {
  const std::size_t columns = std::clamp<std::size_t>(plots.size(), 1, kInARow);
  const std::size_t rows = std::max<std::size_t>(1, (plots.size() + kInARow - 1) / kInARow);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      kWidth * static_cast<double>(columns), kHeight * static_cast<double>(rows));
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const std::size_t row = i / kInARow;
    const std::size_t column = i % kInARow;
    svg += fmt::format("<g transform=\"translate({},{})\">\n{}</g>\n", kWidth * static_cast<double>(column),
                       kHeight * static_cast<double>(row), drawn(plots[i]));
  }
  return svg + "</svg>\n";
}

}  // namespace crisp
