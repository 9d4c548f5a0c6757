// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include <crisp/error.hpp>
#include <crisp/pcd_table.hpp>

#include "pipeline/pcd/lzf.hpp"
#include "pipeline/pcd/pcd_number.hpp"

namespace crisp {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PCD files are little-endian");

constexpr std::size_t kRowsAtOnce = 1 << 16;
constexpr std::size_t kMaxCompressed = std::numeric_limits<std::uint32_t>::max();

/// One field's values.
struct Column {
  PcdField field;
  const char* values;

  const char* at(std::size_t row) const { return values + row * field.width(); }
};

std::vector<Column> columns_of(const PcdTable& table) {
  std::vector<Column> columns;
  const char* values = table.bytes().data();
  for (const auto& field : table.header().fields) {
    columns.push_back({field, values});
    values += field.width() * table.rows();
  }
  return columns;
}

void append_binary(std::string& to, const Column& column, std::size_t row) {
  to.append(column.at(row), column.field.width());
}

/// The shortest digits that are read back as the same number.
void append_ascii(std::string& to, const Column& column, std::size_t row) {
  pcd::visit_number(column.field, [&]<PcdNumber T>(T) {
    for (std::size_t i = 0; i < column.field.count; ++i) {
      T value;
      std::memcpy(&value, column.at(row) + i * sizeof(T), sizeof(T));
      fmt::format_to(std::back_inserter(to), "{} ", +value);
    }
  });
}

/// Row by row, some at a time.
template <class Append>
void write_rows(AtomicFile& out, const PcdTable& table, Append append, bool lines) {
  const auto columns = columns_of(table);
  std::string rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (const auto& column : columns) append(rows, column, row);
    if (lines) rows.back() = '\n';
    if ((row + 1) % kRowsAtOnce == 0 || row + 1 == table.rows()) {
      out.write(rows);
      rows.clear();
    }
  }
}

Error beyond_limit(const AtomicFile& out) {
  return Error(
      "cannot write " + out.path().string() + ": a binary_compressed PCD file cannot hold more than 4 GB",
      "split the file, or use format: binary");
}

void write_compressed(AtomicFile& out, const PcdTable& table) {
  const std::string compressed = pcd::compress_lzf(table.bytes());
  if (compressed.size() > kMaxCompressed) throw beyond_limit(out);
  for (const std::size_t size : {compressed.size(), table.bytes().size()}) {
    const auto bytes = std::bit_cast<std::array<char, 4>>(static_cast<std::uint32_t>(size));
    out.write({bytes.data(), bytes.size()});
  }
  out.write(compressed);
}

}  // namespace

void write_pcd(AtomicFile& out, const PcdTable& table, PcdFormat format) {
  PcdHeader header = table.header();
  header.format = format;
  if (header.format == PcdFormat::binary_compressed && table.bytes().size() > kMaxCompressed) {
    throw beyond_limit(out);
  }
  out.write(to_text(header));
  if (header.format == PcdFormat::ascii) write_rows(out, table, append_ascii, true);
  if (header.format == PcdFormat::binary) write_rows(out, table, append_binary, false);
  if (header.format == PcdFormat::binary_compressed) write_compressed(out, table);
}

}  // namespace crisp
