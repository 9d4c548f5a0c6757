// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/measure.hpp>
#include <crisp/neighbour_search.hpp>
#include <crisp/registrar.hpp>
#include <crisp/term.hpp>

namespace crisp {

/// Everything that comes with the program, registered as a plugin registers what it brings; plugins add to
/// it.
class Builtin {
 public:
  Builtin();
  Builtin(const Builtin&) = delete;
  Builtin& operator=(const Builtin&) = delete;

  /// All that is known by name; valid as long as this object.
  Registrar& registrar() { return registrar_; }

 private:
  TermRegistry terms_;
  SearchRegistry searches_;
  MeasureRegistry measures_;
  Registrar registrar_;
};

}  // namespace crisp
