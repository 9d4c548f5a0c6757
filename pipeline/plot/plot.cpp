// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/plot/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pipeline/plot/axis.hpp"
#include "pipeline/plot/plot_json.hpp"

namespace crisp::plot {
namespace {

constexpr double kWidth = 640, kHeight = 400;  // [pixels] of a plot
constexpr std::size_t kInARow = 2;
constexpr double kLeft = 70, kRight = 20, kTitle = 22, kBottom = 50;  // [pixels] around the curves
constexpr std::array<const char*, 5> kColours = {"#1f5fbf", "#d9731a", "#2a8f3c", "#8a3fa8", "#777777"};
constexpr const char* kMarkColour = "#c01030";
constexpr const char* kDashes = " stroke-dasharray=\"5 3\"";

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

std::string text_at(double x, double y, const char* anchor, const std::string& text, const char* more = "") {
  return fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                     escaped(text));
}

std::string line_along(const std::string& way, const char* colour, double width, const char* more = "") {
  if (way.empty()) return {};
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", way, colour,
                     width, more);
}

std::string dot_at(double x, double y, const char* colour) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\" fill=\"{}\"/>\n", x, y, colour);
}

/// Content and style of a drawn plot.
struct Drawn {
  std::string name;
  const char* colour;
  bool is_line = true;
  const char* dashes = "";
};

std::vector<Drawn> all_drawn(const Plot& plot) {
  std::vector<Drawn> all;
  for (const PlotSeries& series : plot.series) {
    const bool is_line = series.joined && plot.kinds.empty();
    all.push_back(
        {.name = series.name, .colour = kColours[all.size() % kColours.size()], .is_line = is_line});
  }
  for (const PlotMark& mark : plot.marks)
    all.push_back({.name = mark.name, .colour = kMarkColour, .dashes = kDashes});
  return all;
}

/// The names of what is drawn, each behind a piece of it, above the frame.
class Legend {
 public:
  explicit Legend(const Plot& plot) {
    constexpr double kSample = 20, kLetter = 6.5, kBetween = 14;  // [pixels]
    double x = kLeft;
    for (const Drawn& one : all_drawn(plot)) {
      const double width = kSample + kLetter * static_cast<double>(one.name.size());
      if (x > kLeft && x + width > kWidth - kRight) {
        x = kLeft;
        bottom_ += kRow;
      }
      svg_ += sample(one, x, bottom_ - 4) + text_at(x + kSample, bottom_, "start", one.name,
                                                    fmt::format(" fill=\"{}\"", one.colour).c_str());
      x += width + kBetween;
    }
  }
  const std::string& svg() const { return svg_; }
  double bottom() const { return bottom_; }

 private:
  static std::string sample(const Drawn& one, double x, double y) {
    constexpr double kLength = 14;
    if (!one.is_line) return dot_at(x + kLength / 2, y, one.colour);
    return line_along(fmt::format("M{:.1f} {:.1f}h{}", x, y, kLength), one.colour, 1.6, one.dashes);
  }

  static constexpr double kRow = 16;
  std::string svg_;
  double bottom_ = kTitle + kRow;
};

/// The frame of a plot in the picture.
struct Frame {
  double top;
  PlotAxis x;
  PlotAxis y;

  Frame(const Plot& plot, double below)
      : top(below + 8),
        x(horizontal_axis(plot, kLeft, kWidth - kRight)),
        y(vertical_axis(plot, kHeight - kBottom, top)) {}
};

std::string text_below(double x, const std::string& text) {
  return text_at(x, kHeight - kBottom + 16, "middle", text);
}

std::string marks_along_x(const Plot& plot, const Frame& frame) {
  std::string svg;
  for (const PlotKind& kind : plot.kinds) svg += text_below(frame.x.pixel(kind.at), kind.name);
  if (!plot.kinds.empty()) return svg;
  for (const double mark : frame.x.marks()) {
    svg += fmt::format("<path d=\"M{0:.1f} {1:.0f}V{2:.0f}\" stroke=\"#ddd\"/>\n", frame.x.pixel(mark),
                       frame.top, kHeight - kBottom);
    svg += text_below(frame.x.pixel(mark), fmt::format("{:.6g}", mark));
  }
  return svg;
}

std::string drawn_frame(const Plot& plot, const Frame& frame) {
  std::string svg = marks_along_x(plot, frame);
  for (const double mark : frame.y.marks()) {
    svg += fmt::format("<path d=\"M{0:.0f} {1:.1f}H{2:.0f}\" stroke=\"#ddd\"/>\n", kLeft, frame.y.pixel(mark),
                       kWidth - kRight);
    svg += text_at(kLeft - 6, frame.y.pixel(mark) + 4, "end", fmt::format("{:.6g}", mark));
  }
  svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#333\"/>\n",
                     kLeft, frame.top, kWidth - kLeft - kRight, kHeight - frame.top - kBottom);
  svg += text_at(kWidth / 2, kTitle, "middle", plot.title, " font-size=\"14\"");
  svg += text_at(kWidth / 2, kHeight - 12, "middle", plot.x_label);
  svg += text_at(-kHeight / 2, 16, "middle", plot.y_label, " transform=\"rotate(-90)\"");
  return svg;
}

/// [pixels] Offset of a series' points from the other series of its kind.
double next_to_kind(const Plot& plot, std::size_t series) {
  constexpr double kNextTo = 12;
  if (plot.kinds.empty()) return 0;
  return kNextTo * (static_cast<double>(series) - 0.5 * static_cast<double>(plot.series.size() - 1));
}

std::string curve(const Plot& plot, std::size_t number, const Drawn& how, const Frame& frame) {
  const PlotSeries& series = plot.series[number];
  const std::size_t points = std::min(series.x.size(), series.y.size());
  const auto has = [&](std::size_t i) { return i < points && is_shown(plot, series.x[i], series.y[i]); };
  std::string path;
  std::string dots;
  std::string bars;
  for (std::size_t i = 0; i < points; ++i) {
    if (!has(i)) continue;
    const double px = frame.x.pixel(series.x[i]) + next_to_kind(plot, number);
    const double py = frame.y.pixel(series.y[i]);
    const double around = error_at(series, i);
    if (around > 0) {
      bars += fmt::format("M{:.1f} {:.1f}V{:.1f}", px, frame.y.pixel(series.y[i] - around),
                          frame.y.pixel(series.y[i] + around));
    }
    const bool goes_on = i > 0 && has(i - 1);
    if (!how.is_line || (!goes_on && !has(i + 1)))
      dots += dot_at(px, py, how.colour);
    else
      path += fmt::format("{}{:.1f} {:.1f}", goes_on ? "L" : "M", px, py);
  }
  return line_along(path, how.colour, 1.6) + line_along(bars, how.colour, 0.8) + dots;
}

std::string drawn_mark(const PlotMark& mark, const Frame& frame) {
  const double first = frame.x.pixel(mark.at - mark.around), last = frame.x.pixel(mark.at + mark.around);
  const double bottom = kHeight - kBottom;
  std::string svg;
  if (mark.around > 0) {
    svg +=
        fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}V{:.1f}H{:.1f}Z\" fill=\"{}\" fill-opacity=\"0.12\"/>\n",
                    first, frame.top, last, bottom, first, kMarkColour);
  }
  return svg + line_along(fmt::format("M{:.1f} {:.1f}V{:.1f}", frame.x.pixel(mark.at), frame.top, bottom),
                          kMarkColour, 1, kDashes);
}

std::string drawn(const Plot& plot) {
  const Legend legend(plot);
  const Frame frame(plot, legend.bottom());
  const auto all = all_drawn(plot);
  std::string svg = legend.svg() + drawn_frame(plot, frame);
  for (std::size_t i = 0; i < plot.series.size(); ++i) svg += curve(plot, i, all[i], frame);
  for (const PlotMark& mark : plot.marks) svg += drawn_mark(mark, frame);
  return svg;
}

}  // namespace

std::string as_svg(const std::vector<Plot>& plots) {
  const std::size_t columns = std::clamp<std::size_t>(plots.size(), 1, kInARow);
  const std::size_t rows = std::max<std::size_t>(1, (plots.size() + kInARow - 1) / kInARow);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      kWidth * static_cast<double>(columns), kHeight * static_cast<double>(rows));
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const std::size_t row = i / kInARow;
    const std::size_t column = i % kInARow;
    svg += fmt::format("<g transform=\"translate({},{})\">\n<metadata>{}</metadata>\n{}</g>\n",
                       kWidth * static_cast<double>(column), kHeight * static_cast<double>(row),
                       escaped(plot_json(plots[i])), drawn(plots[i]));
  }
  return svg + "</svg>\n";
}

}  // namespace crisp::plot
