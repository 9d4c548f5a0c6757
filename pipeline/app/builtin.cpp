// SPDX-License-Identifier: BSD-3-Clause
#include <crisp/builtin.hpp>
#include <crisp/effect_catalogue.hpp>

#include "grabbers/bag/register.hpp"
#include "grabbers/capture/register.hpp"
#include "grabbers/emulate/emulate_stage.hpp"
#include "grabbers/live/live_stage.hpp"
#include "grabbers/pcd/register.hpp"
#include "grabbers/record/record_stage.hpp"
#include "grabbers/simulate/simulate_stage.hpp"
#include "grabbers/table/register.hpp"
#include "grabbers/telegrams/register.hpp"
#include "grabbers/velodyne/register.hpp"
#include "plugins/assemble/register.hpp"
#include "plugins/calibrate/register.hpp"
#include "plugins/calibrate/watch/register.hpp"
#include "plugins/clock/register.hpp"
#include "plugins/diagnose/register.hpp"
#include "plugins/diagnose/scans/register.hpp"
#include "plugins/filter/register.hpp"
#include "plugins/report/register.hpp"
#include "plugins/study/register.hpp"
#include "plugins/write/register.hpp"

namespace crisp {

Builtin::Builtin() {
  registrar_.attach(terms_, "term");
  registrar_.attach(searches_, "search");
  registrar_.attach(measures_, "measure");
  register_built_in(terms_);
  register_built_in(searches_);
  register_built_in(measures_);
  bag::register_bag(registrar_);
  capture::register_capture(registrar_);
  live::register_live(registrar_);
  emulate::register_emulate(registrar_);
  record::register_record(registrar_);
  pcd_grabber::register_pcd(registrar_);
  table::register_table(registrar_);
  telegrams::register_telegrams(registrar_);
  velodyne::register_velodyne(registrar_);
  simulate::register_simulate(registrar_);
  clock::register_clock(registrar_);
  assemble::register_assemble(registrar_);
  calibrate::register_calibrate(registrar_);
  diagnose::register_diagnose(registrar_);
  filter::register_filter(registrar_);
  report::register_report(registrar_);
  diagnose::register_scans(registrar_);
  study::register_study(registrar_);
  calibrate::register_watch(registrar_);
  write::register_write(registrar_);
}

}  // namespace crisp
