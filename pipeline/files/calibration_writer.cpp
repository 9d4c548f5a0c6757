// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <crisp/atomic_file.hpp>
#include <crisp/calibration_file.hpp>

#include "pipeline/data/internal_error.hpp"

namespace crisp {
namespace {

std::string number(double value, const std::string& what) {
  if (!std::isfinite(value)) throw data::internal_error("calibration: " + what + " is not a finite number");
  return fmt::format("{}", value);  // the shortest text that reads back as the same double
}

/// In double quotes, unless it is a plain word that YAML cannot mistake for anything else.
std::string text(const std::string& raw) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.' || c == '-'; };
  const bool word = !raw.empty() && std::isalpha(static_cast<unsigned char>(raw[0])) &&
                    std::all_of(raw.begin(), raw.end(), plain);
  static const std::set<std::string> kMeanSomething = {"true", "false", "null", "yes", "no", "on", "off",
                                                       "True", "False", "Null", "Yes", "No", "On", "Off",
                                                       "TRUE", "FALSE", "NULL", "YES", "NO", "ON", "OFF"};
  if (word && !kMeanSomething.contains(raw)) return raw;
  std::string quoted = "\"";
  for (const char c : raw) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') quoted += '\\';
    if (byte < 0x20 || byte == 0x7f)
      quoted += fmt::format("\\x{:02x}", byte);
    else
      quoted += c;
  }
  return quoted + '"';
}

std::string parameter(const Parameter& p, const std::string& of) {
  return fmt::format("{{value: {}, unit: {}, std_error: {}, free: {}}}", number(p.value, of + "." + p.name),
                     p.unit == "1" ? "1" : text(p.unit), number(p.std_error, of + "." + p.name + "'s error"),
                     p.free);
}

std::string terms(const std::vector<TermParameters>& list, const std::string& of) {
  if (list.empty()) return {};
  std::string out = "    terms:\n";
  for (const auto& term : list) {
    std::string inside;
    for (const auto& p : term.parameters) {
      inside += fmt::format("{}{}: {}", inside.empty() ? "" : ", ", text(p.name), parameter(p, of));
    }
    out += fmt::format("      {}: {{{}}}\n", text(term.term), inside);
  }
  return out;
}

std::string laser(const LaserCalibration& l) {
  std::string out = fmt::format("  {}:\n", text(l.name));
  for (const Parameter* p : {&l.lambda, &l.tau, &l.alpha, &l.eta}) {
    out += fmt::format("    {:<8}{}\n", p->name + ":", parameter(*p, l.name));
  }
  return out + terms(l.terms, l.name);
}

std::string covariance(const Calibration& c) {
  const std::size_t m = c.covariance_order.size();
  if (c.covariance.size() != m * m) {
    throw data::internal_error(
        fmt::format("calibration: {} values of covariance for {} parameters", c.covariance.size(), m));
  }
  if (m == 0) return "covariance: {order: [], values: []}\n";
  std::string order;
  for (const auto& name : c.covariance_order) order += (order.empty() ? "" : ", ") + text(name);
  std::string out = fmt::format("covariance:\n  order: [{}]\n  values: [\n", order);
  for (std::size_t row = 0; row < m; ++row) {
    out += "    ";
    for (std::size_t column = 0; column < m; ++column) {
      out += number(c.covariance[row * m + column], "the covariance") + (column + 1 < m ? ", " : "");
    }
    out += row + 1 < m ? ",\n" : "\n";
  }
  return out + "  ]\n";
}

/// "rqe_before" and "rqe_after" become rqe: {before: …, after: …}.
std::string quality(const Calibration& c) {
  std::map<std::string, std::map<std::string, double>> pairs;
  std::string out = "quality:\n";
  for (const auto& [name, value] : c.quality) {
    const auto at = name.rfind('_');
    const std::string when = at == std::string::npos ? "" : name.substr(at + 1);
    if (when == "before" || when == "after")
      pairs[name.substr(0, at)][when] = value;
    else
      out += fmt::format("  {}: {}\n", text(name), number(value, name));
  }
  for (const auto& [name, values] : pairs) {
    std::string inside;
    for (const char* when : {"before", "after"}) {
      if (!values.contains(when)) continue;
      inside += fmt::format("{}{}: {}", inside.empty() ? "" : ", ", when, number(values.at(when), name));
    }
    out += fmt::format("  {}: {{{}}}\n", text(name), inside);
  }
  if (c.unobservable.empty()) return out + "  unobservable: []\n";
  out += "  unobservable:\n";
  for (const auto& u : c.unobservable) {
    out += fmt::format("    - {{parameter: {}, reason: {}, combination: {}}}\n", text(u.parameter),
                       text(u.reason), text(u.combination));
  }
  return out;
}

std::string caveats(const Calibration& c) {
  std::string out;
  for (const auto& caveat : c.caveats) out += fmt::format("  - {}\n", text(caveat));
  return out.empty() ? out : "caveats:\n" + out;
}

std::string plate(const Calibration& c) {
  const bool clockwise = c.direction == CountDirection::clockwise;
  if (!clockwise && c.plate_terms.empty()) return "plate: {}\n";
  return fmt::format("plate:\n{}{}", clockwise ? "    direction: clockwise\n" : "",
                     terms(c.plate_terms, "plate"));
}

std::string provenance(const Calibration& c) {
  if (c.provenance.empty()) return "provenance: {}\n";
  std::string out = "provenance:\n";
  for (const auto& [key, value] : c.provenance) out += fmt::format("  {}: {}\n", text(key), text(value));
  return out;
}

}  // namespace

std::string to_yaml(const Calibration& c) {
  std::string out = "crisp: 1\n" + caveats(c) + "lasers:\n";
  for (const auto& l : c.lasers) out += laser(l);
  return out + plate(c) + covariance(c) + quality(c) + provenance(c);
}

void write_calibration(const std::filesystem::path& file, const Calibration& calibration) {
  write_file(file, to_yaml(calibration));
}

}  // namespace crisp
