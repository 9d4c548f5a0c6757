// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/encoder_line_yaml.hpp"

namespace crisp::files {

EncoderLine read_encoder_line(const YamlNode& node, std::vector<Error>& errors) {
  constexpr std::int64_t kMostColumns = 64;
  YamlMap map(node, "plate, line", errors);
  EncoderLine line;
  line.begin = map.text("begin", "");
  line.separators = map.text("separators", line.separators);
  const auto column = [&](const char* key) {
    return static_cast<std::size_t>(map.integer(key, 1, 1, kMostColumns));
  };
  map.require("count_column");
  line.count_column = column("count_column");
  if (map.find("time_column")) line.time_column = column("time_column");
  line.time_unit =
      read_choice<double>(map, "time_unit", {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}, 1e-6,
                          "unit of time", "write s, ms, us or ns");
  line.checksum = read_choice<LineChecksum>(
      map, "checksum",
      {{"none", LineChecksum::none}, {"xor", LineChecksum::exclusive_or}, {"crc8", LineChecksum::crc8}},
      LineChecksum::none, "checksum", "write none, xor or crc8");
  if (line.time_column == line.count_column)
    map.fail(map.find("time_column")->place, "'time_column' and 'count_column' are the same",
             "give the columns of the encoder's time and of its count");
  if (line.separators.empty() || line.separators.find_first_of("+-.0123456789*\n") != std::string::npos)
    map.fail(map.find("separators")->place, "'separators' are empty, or characters of numbers",
             "write the characters between two columns, such as \",\"");
  map.refuse_others();
  return line;
}

}  // namespace crisp::files
