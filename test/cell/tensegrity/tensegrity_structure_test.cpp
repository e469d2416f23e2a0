#include "cell/tensegrity/tensegrity_structure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cell/mechanics/term_derivatives.h"
#include "cell/tensegrity/bundles.h"
#include "cell/tensegrity/tensegrity_loading.h"

namespace microinjection {
namespace {

/// In equilibrium where the analytic form has it, but for what the membrane's coarse facets pull.
TEST(TensegrityStructure, StandsInEquilibriumUnderItsPrestress) {
  for (const double prestrain : {0.05, 0.5}) {
    const auto structure = make(bundles(prestrain));
    const TensegrityStructure::Form& form = structure->form();
    EXPECT_LT(form.residual, 1e-9 * form.prestress);
    EXPECT_NEAR(form.prestress / structure->config().actin.tension(), 1, 0.02);
    for (int end = 0; end < 12; ++end) {
      const Eigen::Vector3d at = structure->position(structure->endNode(end), structure->start());
      EXPECT_LT((at - structure->geometry().ends[end]).norm(), 5e-4 * 28e-6);
    }
    // The residual again, of terms made anew and by the checker's own sum.
    const TensegrityStructure::Parts parts = structure->makeParts();
    Eigen::VectorXd force = Eigen::VectorXd::Zero(structure->start().size());
    LocalEnergy local;
    for (const auto& term : parts.terms) {
      for (int e = 0; e < term->elementCount(); ++e) {
        ASSERT_TRUE(term->evaluate(e, structure->start(), Order::kGradient, local));
        for (std::size_t i = 0; !local.zero && i < term->entries(e).size(); ++i) {
          force[term->entries(e)[i]] += local.gradient[i];
        }
      }
    }
    Eigen::Vector3d held = Eigen::Vector3d::Zero();
    for (const int node : structure->heldNodes()) {
      held += force.segment<3>(3 * node);
      force.segment<3>(3 * node).setZero();
    }
    EXPECT_LT(force.lpNorm<Eigen::Infinity>(), 1e-9 * form.prestress);
    EXPECT_LT(held.norm(), 1e-7 * form.prestress);  // it stands by itself
  }
}

/// What the struts bear is sqrt(6) times the actin cables' tension where only these pull.
TEST(TensegrityStructure, StrutsBearWhatTheAnalyticFormSays) {
  TensegrityConfig config = bundles();
  config.intermediate.prestrain = 0;
  config.membrane.tension = 0;
  config.microtubules.bow = 0;
  config.microtubules.element = "p2";
  const auto structure = make(config);
  const double tension = structure->form().prestress;
  // Mean stress over the strut's middle from the deformation of its elements.
  const LayeredBody<3>& struts = structure->struts();
  const Material& material = *struts.materials()[0];
  double force_length = 0, length = 0;
  for (int e = 0; e < struts.elementCount() / 6; ++e) {
    for (int q = 0; q < struts.pointCount(); ++q) {
      const Eigen::Vector3d axis = (structure->geometry().ends[1] - structure->geometry().ends[0]).normalized();
      const Eigen::Matrix3d stress = material.stress(struts.deformationGradient(e, q, structure->start()));
      force_length -= struts.weight(e, q) * axis.dot(stress * axis);
    }
  }
  length =
      (structure->nodePositions()[structure->endNode(1)] - structure->nodePositions()[structure->endNode(0)]).norm();
  EXPECT_NEAR(force_length / length / tension / std::sqrt(6.0), 1, 2e-3);  // virial: the integral of stress is P L
  EXPECT_NEAR(-structure->strutForce(0, structure->start()) / tension / std::sqrt(6.0), 1, 2e-3);
}

TEST(TensegrityStructure, DerivativesAreThoseOfTheEnergy) {
  TensegrityConfig config = bundles();
  config.membrane.divisions = 1;
  config.microtubules.slices = 2;
  for (const std::string& model : strutModels()) {
    config.microtubules.model = model;
    const auto structure = make(config);
    const TensegrityStructure::Parts parts = structure->makeParts();
    const double radius = config.microtubules.filaments.radius();
    Eigen::VectorXd state = structure->start();
    for (int i = 0; i < state.size(); ++i) state[i] += 0.02 * radius * std::sin(3.7 * i);
    for (const auto& term : parts.terms) expectDerivatives(*term, state, 1e-5 * radius, 1e-6);
  }
}

TEST(TensegrityStructure, WithoutPrestressTheMembraneHoldsIt) {
  const auto structure = make(bundles(0));
  EXPECT_LT(structure->form().prestress, 0.01 * bundles().actin.tension());
  TensegrityLoading loading(structure, {structure->endNode(topEnd(structure->geometry()))});
  ASSERT_TRUE(loading.advance({0, 0, -3e-6}).converged);
  EXPECT_GT(loading.force().z(), 0);
}

/// Struts whose Euler load the prestress exceeds bow out until the cables are relieved: still an equilibrium, with less
/// tension than prescribed. The second-order element's Euler load is the beam's.
TEST(TensegrityStructure, StrutsBuckleUnderAPrestressAboveTheirEulerLoad) {
  TensegrityConfig config = bundles();
  config.microtubules.element = "p2";
  config.microtubules.slices = 8;
  config.membrane.tension = 0;
  for (const double share : {0.3, 1.5}) {  // of the Euler load
    const TensegrityGeometry geometry(config);
    FilamentConfig& tubules = config.microtubules.filaments;
    tubules.count = static_cast<int>(std::sqrt(
        geometry.strut_force / share / (tubules.eulerLoad(geometry.strut_length) / tubules.count / tubules.count)));
    const auto structure = make(config);
    double bow = 0;
    for (int i = 0; i < 6; ++i) {
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const int node : structure->middleNodes(i)) middle += structure->position(node, structure->start()) / 5;
      const auto& [a, b] = geometry.struts[i];
      const Eigen::Vector3d ends = structure->position(structure->endNode(a), structure->start()) +
                                   structure->position(structure->endNode(b), structure->start());
      bow = std::max(bow, (middle - ends / 2).norm() / geometry.strut_length);
    }
    EXPECT_LT(structure->form().residual, 1e-9 * structure->form().prestress);
    if (share < 1) {
      EXPECT_NEAR(bow / (config.microtubules.bow / (1 - share)), 1, 0.1);  // amplified by 1 / (1 - P / P_Euler)
    } else {
      EXPECT_GT(bow, 0.05);
    }
  }
}

TEST(TensegrityStructure, ACutCableIsMissedAndTheRestFindsItsForm) {
  TensegrityConfig config = bundles();
  const TensegrityGeometry geometry(config);
  const int top = topEnd(geometry);
  for (int cable = 0; cable < 36; ++cable) {
    if (geometry.cables[cable].a == top || geometry.cables[cable].b == top) config.cut = {cable};
  }
  const auto whole = make(bundles()), cut = make(config);
  EXPECT_EQ(cut->makeParts().cables->elementCount(), 35);
  EXPECT_LT(cut->form().residual, 1e-9 * cut->form().prestress);
  TensegrityLoading a(whole, {whole->endNode(top)}), b(cut, {cut->endNode(top)});
  ASSERT_TRUE(a.advance({0, 0, -2e-6}).converged);
  ASSERT_TRUE(b.advance({0, 0, -2e-6}).converged);
  EXPECT_LT(b.force().z(), 0.98 * a.force().z());
}

TEST(TensegrityStructure, KnowsActinWhereACableIsCut) {
  TensegrityConfig config = bundles();
  config.cut = {5};
  const auto structure = make(config);
  for (int i = 0; i < 35; ++i) EXPECT_EQ(structure->isActin(i), i < 23) << i;
}

/// The counts of config/cells/mouse_oocyte_tensegrity.yaml at ten times its prestress: struts at a third of their Euler
/// load.
TEST(TensegrityStructure, StandsUnderTenTimesThePrestress) {
  TensegrityConfig config = bundles(0.5);
  config.actin.filaments.count = config.intermediate.filaments.count = 100;
  config.microtubules.filaments.count = 12500;
  const auto structure = make(config);
  EXPECT_LT(structure->form().residual, 1e-9 * structure->form().prestress);
  EXPECT_NEAR(structure->form().prestress / config.actin.tension(), 1, 0.02);
  EXPECT_LT(structure->form().iterations, 500);
}

}  // namespace
}  // namespace microinjection
