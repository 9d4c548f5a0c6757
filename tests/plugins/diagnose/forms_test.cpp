// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/forms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace crisp {
namespace {

using Others = std::vector<Candidate::OtherForm>;

TEST(FormError, IsNothingWhereOtherFormsExplainMuchLess) {
  EXPECT_EQ(form_error({}, 1), 0);
  EXPECT_LT(form_error(Others{{.off = 3, .behind = 100}, {.off = -5, .behind = 200}}, 1), 1e-10);
}

TEST(FormError, IsTheSpreadOfFormsEachAsLikelyAsTheDataMakeIt) {
  // Another explains as much: half of the time the right one is 3 off.
  EXPECT_NEAR(form_error(Others{{.off = 3, .behind = 0}}, 1), 3 / std::sqrt(2), 1e-12);
  // e⁻¹ as likely: 1 + e⁻¹ in all.
  EXPECT_NEAR(form_error(Others{{.off = 3, .behind = 2}}, 1),
              3 * std::sqrt(std::exp(-1) / (1 + std::exp(-1))), 1e-12);
}

TEST(FormError, KnowsThatBeamsShareErrors) {
  EXPECT_NEAR(form_error(Others{{.off = 3, .behind = 20}}, 10),
              form_error(Others{{.off = 3, .behind = 2}}, 1), 1e-12);
}

}  // namespace
}  // namespace crisp
