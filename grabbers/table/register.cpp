// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/register.hpp"

#include "grabbers/table/encoder_lines_stage.hpp"
#include "grabbers/table/table_stage.hpp"

namespace crisp::table {

void register_table(Registrar& registrar) {
  registrar.stage<TableStage>();
  registrar.stage<EncoderLinesStage>();
}

}  // namespace crisp::table
