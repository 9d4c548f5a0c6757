// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>

#include "pipeline/files/json_text.hpp"

namespace crisp::batch {
namespace {

using Json = nlohmann::ordered_json;

/// A field of CSV (RFC 4180).
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Empty where it is no number.
std::string field(double number) { return std::isfinite(number) ? fmt::format("{}", number) : std::string(); }

template <class Number>
std::string field(const std::optional<Number>& number) {
  return number ? field(static_cast<double>(*number)) : std::string();
}

std::string field(const std::vector<std::string>& texts) {
  return field(fmt::format("{}", fmt::join(texts, "; ")));
}

/// Names of what at least one row has.
template <class Member>
std::set<std::string> names_of(const BatchRows& rows, Member member) {
  std::set<std::string> names;
  for (const auto& row : rows.rows) {
    for (const auto& [name, value] : row.*member) names.insert(name);
  }
  return names;
}

std::string line_of(const BatchRow& row, const std::set<std::string>& qualities,
                    const std::set<std::string>& parameters) {
  std::vector<std::string> fields = {field(row.name),
                                     row.status,
                                     field(row.reasons),
                                     row.ended,
                                     fmt::format("{}", row.seconds),
                                     fmt::format("{}", row.cpu_seconds),
                                     fmt::format("{}", row.memory),
                                     fmt::format("{}", row.input_bytes),
                                     field(row.begin),
                                     field(row.points),
                                     field(row.causes),
                                     field(row.stands_out)};
  for (const auto& name : qualities) {
    const auto found = row.quality.find(name);
    fields.push_back(found == row.quality.end() ? "" : field(found->second));
  }
  for (const auto& name : parameters) {
    const auto found = row.parameters.find(name);
    const bool known = found != row.parameters.end();
    fields.push_back(known ? field(found->second.value) : "");
    fields.push_back(known ? field(found->second.std_error) : "");
  }
  return fmt::format("{}\n", fmt::join(fields, ","));
}

Json parameters_json(const BatchRow& row) {
  Json parameters = Json::object();
  for (const auto& [name, parameter] : row.parameters) {
    Json& json = parameters[name] = {{"value", parameter.value}, {"unit", parameter.unit}};
    if (parameter.std_error) json["std_error"] = *parameter.std_error;
  }
  return parameters;
}

Json row_json(const BatchRow& row) {
  Json json = {{"name", row.name},       {"status", row.status},
               {"reasons", row.reasons}, {"ended", row.ended},
               {"seconds", row.seconds}, {"cpu_seconds", row.cpu_seconds},
               {"memory", row.memory},   {"input_bytes", row.input_bytes},
               {"causes", row.causes},   {"stands_out", row.stands_out},
               {"quality", row.quality}, {"parameters", parameters_json(row)}};
  if (row.begin) json["begin"] = *row.begin;
  if (row.points) json["points"] = *row.points;
  return json;
}

}  // namespace

void print_csv(const BatchRows& rows, const TextSink& sink) {
  const auto qualities = names_of(rows, &BatchRow::quality);
  const auto parameters = names_of(rows, &BatchRow::parameters);
  std::string names =
      "name,status,reasons,ended,seconds,cpu_seconds,memory,input_bytes,begin,points,causes,stands_out";
  for (const auto& name : qualities) names += "," + field(name);
  for (const auto& name : parameters) names += "," + field(name) + "," + field(name + ".std_error");
  sink(names + "\n");
  for (const auto& row : rows.rows) sink(line_of(row, qualities, parameters));
}

Json head_json(const BatchRows& rows) {
  Json json = {{"crisp", rows.batch.value("crisp", "")},
               {"pipeline", rows.batch.value("pipeline", "")},
               {"settings", rows.settings},
               {"recordings", rows.recordings},
               {"counts", Json::object()}};
  for (const char* status : {"done", "untrusted", "failed", "interrupted", "running", "due"})
    json["counts"][status] = rows.count(status);
  return json;
}

void print_json(const BatchRows& rows, const Json& head, const TextSink& sink) {
  std::string begin = files::json_text(head, 1);
  begin.resize(begin.find_last_of('}'));  // which follows the rows
  while (begin.back() == '\n' || begin.back() == ' ') begin.pop_back();
  sink(begin + ",\n \"rows\": [");
  for (const auto& row : rows.rows)
    sink((&row == &rows.rows.front() ? "\n  " : ",\n  ") + files::json_text(row_json(row)));
  sink("\n ]\n}\n");
}

}  // namespace crisp::batch
