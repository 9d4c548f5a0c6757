// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "grabbers/table/table_items.hpp"
#include "grabbers/table/table_reader.hpp"

namespace crisp::table {

/// `grabber.table`: scans of any actuated laser, with the actuator's angles, from text in columns.
class TableStage final : public Stage {
 public:
  static void describe(StageDescription<TableStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  void check_columns() const;
  void read(TableReader& reader, TableItems& items, Outputs& out, Context& context) const;
  /// Gives completed items, so that memory does not grow with the table.
  static void give_piece(TableItems& items, Outputs& out);
  void report(const TableReader& reader, const TableItems& items, std::uint64_t beams,
              Context& context) const;

  std::filesystem::path file_;
  TableFormat format_;
  TableScanSettings settings_;
  double begin_ = 0;
  std::optional<double> duration_;
};

}  // namespace crisp::table
