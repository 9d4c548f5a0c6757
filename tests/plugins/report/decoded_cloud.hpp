// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugins/report/encoded_cloud.hpp"

namespace crisp::test {

/// RFC 4648, by its definition.
inline std::string decoded_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(letters.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFFU);
  }
  return bytes;
}

/// The columns of a page's cloud, decoded by its header.
inline std::map<std::string, std::vector<double>> decoded_cloud(const report::EncodedCloud& cloud) {
  const std::string packed = decoded_base64(cloud.base64);
  const auto n = cloud.header.at("points").get<std::size_t>();
  std::size_t width = 0;
  for (const auto& column : cloud.header.at("columns")) width += column.at("bytes").get<std::size_t>();
  std::vector<unsigned char> bytes(n * width);
  uLongf size = bytes.size();
  if (uncompress(bytes.data(), &size, reinterpret_cast<const unsigned char*>(packed.data()), packed.size()) !=
          Z_OK ||
      size != bytes.size())
    throw std::runtime_error("the cloud cannot be unpacked");
  std::map<std::string, std::vector<double>> columns;
  std::size_t begin = 0;
  for (const auto& column : cloud.header.at("columns")) {
    const auto wide = column.at("bytes").get<std::size_t>();
    const std::uint64_t modulus = std::uint64_t{1} << (8 * wide);
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < n; ++i) {
      std::uint64_t stored = 0;
      for (std::size_t b = 0; b < wide; ++b) stored |= std::uint64_t{bytes[begin + b * n + i]} << (8 * b);
      number = column.at("delta") ? (number + stored) % modulus : stored;
      const bool is_none = column.at("gaps") && number == modulus - 1;
      columns[column.at("name")].push_back(is_none ? std::numeric_limits<double>::quiet_NaN()
                                                   : column.at("offset").get<double>() +
                                                         column.at("step").get<double>() *
                                                             static_cast<double>(number));
    }
    begin += wide * n;
  }
  return columns;
}

}  // namespace crisp::test
