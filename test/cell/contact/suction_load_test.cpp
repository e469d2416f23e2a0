#include "cell/contact/suction_load.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "cell/mechanics/bodies.h"
#include "cell/mechanics/term_derivatives.h"
#include "cell/mesh/section_mesher.h"
#include "cell/mesh/swept_mesh.h"

namespace microinjection {
namespace {

constexpr double kCell = 40e-6, kMouth = 12e-6, kEdge = 2e-6, kUnit = 1e8;  // m, Pa/m

template <int Dim>
struct Held {
  Held() : body(mesh(), ElementKind::kP2, {makeMaterial({})}), mouth(kMouth, 30e-6, kEdge, -1) {
    RigidContactConfig config;
    config.moves = {false, false, false};
    config.origin.z() = plane();
    config.penalty = 1e12;
    lip = std::make_shared<RigidContact<Dim>>(body, std::make_shared<PipetteMouth>(mouth), config);
    load = std::make_unique<SuctionLoad<Dim>>(body, mouth, kCell, plane(), lip, body.tipEntry() + 1, kUnit);
  }

  static QuadraticMesh<Dim> mesh() {
    SectionMeshConfig config;
    config.radii = {kCell};
    config.size = 8e-6;
    config.refinements = {{kMouth, -1, kEdge, 0.5e-6}};
    const QuadraticMesh<2> section = makeQuadratic(makeSectionMesh(config), config.radii);
    if constexpr (Dim == 2) {
      return section;
    } else {
      return sweepSection(section, {});
    }
  }
  double plane() const { return -PipetteMouth(kMouth, 30e-6, kEdge, -1).touchDistance(kCell); }
  /// At rest, but for a pressure (Pa).
  Eigen::VectorXd rest(double pressure) const {
    Eigen::VectorXd state = Eigen::VectorXd::Zero(body.stateSize());
    state[body.tipEntry() + 1] = pressure / kUnit;
    return state;
  }

  LayeredBody<Dim> body;
  PipetteMouth mouth;
  std::shared_ptr<RigidContact<Dim>> lip;
  std::unique_ptr<SuctionLoad<Dim>> load;
};

template <typename Dimension>
class SuctionLoadTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SuctionLoadTest, Dimensions);

TYPED_TEST(SuctionLoadTest, DerivativesAreThoseOfTheEnergy) {
  const Held<TypeParam::value> held;
  Eigen::VectorXd state = held.rest(-700);
  state.head(state.size() - 3) += randomVector(state.size() - 3, 0.05e-6);
  EXPECT_GT(expectDerivatives(*held.load, state, 1e-10, 2e-5, TypeParam::value == 2 ? 1 : 7), 20);
}

/// The sphere's cap behind the seal, which lies on the lip's inner flank, and the disc from there to the crest's plane.
TYPED_TEST(SuctionLoadTest, VolumeIsThatOfTheCap) {
  const Held<TypeParam::value> held;
  const double s = held.load->sealRadius(), seal = std::sqrt(kCell * kCell - s * s), height = kCell - seal;
  const double cap = M_PI * height * height * (3 * kCell - height) / 3;
  const double expected = cap + M_PI * s * s * (held.plane() + seal);
  EXPECT_NEAR(held.load->volume(held.rest(0)), expected, 0.01 * cap);
  EXPECT_NEAR(held.load->apex(held.rest(0)), kCell + held.plane(), 1e-12);
}

/// Suction on a body at rest: pressure times the seal's area, along the axis.
TYPED_TEST(SuctionLoadTest, ForceIsPressureTimesArea) {
  constexpr int kDim = TypeParam::value;
  const Held<kDim> held;
  const double pressure = -1000;
  const Eigen::VectorXd state = held.rest(pressure);
  double force = 0;
  LocalEnergy local;
  for (int facet = 0; facet < held.load->elementCount(); ++facet) {
    ASSERT_TRUE(held.load->evaluate(facet, state, Order::kGradient, local));
    for (std::size_t i = kDim - 1; i + 1 < held.load->entries(facet).size(); i += kDim)
      force -= local.gradient[static_cast<Eigen::Index>(i)];
  }
  const double s = held.load->sealRadius();
  EXPECT_NEAR(force, pressure * M_PI * s * s, 0.02 * std::abs(pressure) * M_PI * s * s);  // towards the mouth
}

}  // namespace
}  // namespace microinjection
