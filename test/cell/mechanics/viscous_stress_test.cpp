#include "cell/mechanics/viscous_stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/errors.h"
#include "cell/mechanics/bodies.h"
#include "cell/mechanics/term_derivatives.h"
#include "cell/mechanics/viscous_cases.h"

namespace microinjection {
namespace {

template <typename Case>
class ViscousStressTest : public testing::Test {
 protected:
  static constexpr int kAxis = Case::kDim - 1;
  using Point = Eigen::Matrix<double, Case::kDim, 1>;
  using Term = ViscousStress<Case::kDim>;

  static std::shared_ptr<LayeredBody<Case::kDim>> block(const std::string& model) {
    return makeBody(irregularBlock<Case::kDim>(2), Case::kKind, model, 0.3);
  }
  /// Of a stretch 1 + e along z.
  static Eigen::VectorXd stretched(const LayeredBody<Case::kDim>& body, double e) {
    return stateOf(body, [e](const Point& x) -> Point { return e * x[kAxis] * Point::Unit(kAxis); });
  }
};

TYPED_TEST_SUITE(ViscousStressTest, ViscousCases, ElementCaseName);

TYPED_TEST(ViscousStressTest, DerivativesAreThoseOfTheEnergy) {
  for (const std::string model : {"linear", "neo_hookean", "corotated"}) {
    const auto body = this->block(model);
    typename TestFixture::Term viscous(body, {kAll});
    for (int seed : {1, 2}) {  // so that something is remembered
      viscous.beginStep(0.05);
      viscous.accept(randomVector(body->stateSize(), 0.03, seed));
    }
    viscous.beginStep(0.1);
    const Eigen::VectorXd state = randomVector(body->stateSize(), 0.03, 3);
    SCOPED_TRACE(model);
    EXPECT_EQ(expectDerivatives(viscous, state, 1e-6, 1e-7, 7), (viscous.elementCount() + 6) / 7);
  }
}

TYPED_TEST(ViscousStressTest, AddsNothingInAnInfiniteDuration) {
  const auto body = this->block("neo_hookean");
  typename TestFixture::Term viscous(body, {kAll});
  const Eigen::VectorXd state = this->stretched(*body, 0.2);
  LocalEnergy local;
  ASSERT_TRUE(viscous.evaluate(0, state, Order::kHessian, local));
  EXPECT_TRUE(local.zero);  // before the first step
  viscous.beginStep(0.1);
  ASSERT_TRUE(viscous.evaluate(0, state, Order::kHessian, local));
  EXPECT_FALSE(local.zero);
  viscous.beginStep(kForever);
  ASSERT_TRUE(viscous.evaluate(0, state, Order::kHessian, local));
  EXPECT_TRUE(local.zero);
  viscous.accept(state);
  viscous.beginStep(0.1);  // relaxed there: no stress, while the undeformed state would not be free of it now
  EXPECT_LT(gradientOf(viscous, state).norm(), 1e-13);
  EXPECT_GT(gradientOf(viscous, 0 * state).norm(), 0.1);
}

TYPED_TEST(ViscousStressTest, OnlyAnAcceptedStepIsRemembered) {
  const auto body = this->block("neo_hookean");
  typename TestFixture::Term viscous(body, {kAll}), untried(body, {kAll});
  const Eigen::VectorXd there = this->stretched(*body, 0.2), then = this->stretched(*body, 0.1);
  untried.beginStep(0.1);
  viscous.beginStep(3);
  gradientOf(viscous, there);
  viscous.beginStep(0.1);
  EXPECT_EQ(gradientOf(viscous, then), gradientOf(untried, then));
  viscous.accept(there);
  viscous.beginStep(0.1);
  EXPECT_GT((gradientOf(viscous, then) - gradientOf(untried, then)).norm(), 0.1);
  viscous.reset();
  LocalEnergy local;
  ASSERT_TRUE(viscous.evaluate(0, then, Order::kEnergy, local));
  EXPECT_TRUE(local.zero);
  viscous.beginStep(0.1);
  EXPECT_EQ(gradientOf(viscous, then), gradientOf(untried, then));
}

TYPED_TEST(ViscousStressTest, LayersHaveWhatIsTheirs) {
  auto mesh = irregularBlock<TypeParam::kDim>(2);
  const int elements = static_cast<int>(mesh.elements.size());
  for (int e = 0; e < elements; ++e) mesh.layers[e] = e % 3;
  const auto soft = material("neo_hookean", 0.3, 1), stiff = material("mooney_rivlin", 0.4, 5);
  const auto body = std::make_shared<LayeredBody<TypeParam::kDim>>(
      std::move(mesh), TypeParam::kKind, typename LayeredBody<TypeParam::kDim>::Materials{soft, soft, stiff});
  typename TestFixture::Term viscous(body, {kProny, {}, kAll});
  EXPECT_EQ(viscous.elementCount(), elements - (elements + 1) / 3);
  const double duration = 0.2;
  viscous.beginStep(duration);
  const Eigen::VectorXd state = this->stretched(*body, 0.2);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(2, 2) = 1.2;
  const auto density = [&](const Material& of, const ViscoelasticityConfig& config) {
    return ViscoelasticStep(of, config, duration).energy(ViscoelasticMemory(config), of.kinematics(F));
  };
  double expected = 0, energy = 0;
  for (int e = 0; e < elements; ++e) {
    double volume = 0;
    for (int q = 0; q < body->pointCount(); ++q) volume += body->weight(e, q);
    expected += volume * (e % 3 == 0 ? density(*soft, kProny) : e % 3 == 2 ? density(*stiff, kAll) : 0);
  }
  LocalEnergy local;
  for (int e = 0; e < viscous.elementCount(); ++e) {
    ASSERT_TRUE(viscous.evaluate(e, state, Order::kEnergy, local));
    energy += local.energy;
  }
  EXPECT_NEAR(energy, expected, 1e-12 * expected);
}

TYPED_TEST(ViscousStressTest, HasNoEnergyWhereTheMaterialHasNone) {
  const auto has = [&](const std::string& model, double e) {
    const auto body = this->block(model);
    typename TestFixture::Term viscous(body, {kAll});
    viscous.beginStep(0.1);
    LocalEnergy local;
    return viscous.evaluate(0, this->stretched(*body, e), Order::kHessian, local);
  };
  EXPECT_FALSE(has("neo_hookean", -1.3));
  EXPECT_TRUE(has("linear", -1.3));
  EXPECT_FALSE(has("gent", 4.6));  // I1 - 3 = 30.4, of 30
  EXPECT_TRUE(has("gent", 4.5));
}

TYPED_TEST(ViscousStressTest, RefusesWhatItCannotBe) {
  using Viscous = typename TestFixture::Term;
  const auto body = this->block("linear");
  EXPECT_THROW(Viscous(body, {}), std::invalid_argument);
  EXPECT_THROW(Viscous(body, {kAll, kAll}), std::invalid_argument);
  EXPECT_THROW(Viscous(body, {{{}, -1}}), ConfigError);
  Viscous viscous(body, {kAll});
  EXPECT_THROW(viscous.beginStep(0), std::invalid_argument);
  EXPECT_THROW(viscous.beginStep(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
