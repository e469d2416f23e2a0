#include "cell/identification/curve_model.h"

#include <gtest/gtest.h>

#include "cell/identification/formula_law.h"
#include "made_up_record.h"

namespace microinjection {
namespace {

TEST(CurveModel, DerivativesAreThoseOfTheForce) {
  const ForceCurve curve = MadeUpRecord().make(*hertz());
  CurveModel model(curve, hertz(), {true, 2});
  model.start(2e3, 3.1001e-6, -40e-9, 3e-9);
  ASSERT_EQ(model.unknowns().size(), 8u);
  Eigen::VectorXd at(8), force, above, below;
  for (int p = 0; p < 8; ++p) at[p] = model.unknowns()[p].value;
  Eigen::MatrixXd jacobian, unused;
  model.predict(at, force, jacobian);
  for (int p = 0; p < 8; ++p) {
    const double step = 1e-4;
    Eigen::VectorXd moved = at;
    moved[p] += step;
    model.predict(moved, above, unused);
    moved[p] -= 2 * step;
    model.predict(moved, below, unused);
    const Eigen::VectorXd difference = (above - below) / (2 * step);
    EXPECT_LT((difference - jacobian.col(p)).norm(), 2e-4 * jacobian.col(p).norm()) << model.unknowns()[p].name;
  }
}

TEST(CurveModel, RelaxationIsThatOfTheSuite) {
  const ForceCurve curve = MadeUpRecord().make(*hertz());
  CurveModel model(curve, hertz(), {false, 1});
  model.start(2e3, 3.1e-6, 0, 0);
  Eigen::VectorXd at(6), force;
  for (int p = 0; p < 6; ++p) at[p] = model.unknowns()[p].value;
  at[4] = std::log(0.5);
  at[5] = std::log(0.1);
  Eigen::MatrixXd jacobian;
  model.predict(at, force, jacobian);
  // A ramp of F ~ t^1.5 with one term, integrated finely.
  double branch = 0, before = 0;
  Eigen::VectorXd none;
  const double end = curve.time.back(), contact_time = 3.1e-6 / 20e-6, step = 1e-6;
  for (double time = contact_time; time < end; time += step) {
    const double elastic = 2e3 * hertz()->force(20e-6 * (time + step - contact_time), none).force;
    branch += 0.5 * (elastic - before) - branch * step / 0.1;
    before = elastic;
  }
  EXPECT_NEAR(force[force.size() - 1], before + branch, 2e-3 * force[force.size() - 1]);
}

TEST(FormulaLaw, HertzOnABallIsSofter) {
  FormulaGeometry geometry;
  geometry.tip_radius = 5e-6;
  geometry.poisson_ratio = 0.5;
  Eigen::VectorXd none;
  const double plane = makeFormulaLaw("hertz", geometry)->force(1e-6, none).force;
  EXPECT_NEAR(plane, 4.0 / 3 * std::sqrt(5e-6) / 0.75 * 1e-9, 1e-18);
  geometry.cell_radius = 5e-6;
  EXPECT_NEAR(makeFormulaLaw("hertz", geometry)->force(1e-6, none).force, plane / std::sqrt(2), 1e-18);
}

}  // namespace
}  // namespace microinjection
