#include "cell/mechanics/surface_tension.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include "cell/mechanics/term_derivatives.h"
#include "cell/mesh/pierced_section.h"
#include "cell/mesh/round_shapes.h"

namespace microinjection {
namespace {

constexpr double kTension = 0.4e-3;                      // N/m
const std::vector<double> kTenseRadii = {60e-6, 30e-6};  // m
constexpr double kSphere = 4 * M_PI * 60e-6 * 60e-6;     // m^2, area of the outer surface

/// `fineness` doubles, edges halve.
template <int Dim>
LayeredBody<Dim> ball(ElementKind kind, int fineness) {
  MaterialConfig config;
  config.model = "neo_hookean";
  const LayeredBody<3>::Materials materials(2, std::shared_ptr<const Material>(makeMaterial(config)));
  if constexpr (Dim == 2) {
    return {makeQuadratic(layeredHalfDisc(8 * fineness, kTenseRadii), kTenseRadii), kind, materials};
  } else {
    const int level = fineness == 1 ? 1 : fineness == 2 ? 2 : 3;
    return {makeQuadratic(layeredBall(level, kTenseRadii), kTenseRadii), kind, materials};
  }
}

template <int Dim>
struct TensionProblem {
  using Vector = Eigen::Matrix<double, Dim, 1>;

  explicit TensionProblem(ElementKind kind, int fineness = 1, int layer = 0)
      : body(ball<Dim>(kind, fineness)), surface(body, layer, kTenseRadii[layer], kTension) {}

  /// State of a deformation x(X); MINI's bubbles stay.
  Eigen::VectorXd state(const std::function<Vector(const Vector&)>& deform) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(body.stateSize());
    const int nodes = isQuadratic(body.kind()) ? body.nodeCount() : body.mesh().vertex_count;
    for (int n = 0; n < nodes; ++n) {
      const Vector& X = body.mesh().nodes[n];
      result.segment<Dim>(Dim * n) = deform(X) - X;
    }
    return result;
  }

  Eigen::VectorXd random(double amplitude) const {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> entry(-amplitude, amplitude);
    return Eigen::VectorXd::NullaryExpr(body.stateSize(), [&] { return entry(generator); });
  }

  double energy(const Eigen::VectorXd& at) const {
    LocalEnergy local;
    double sum = 0;
    for (int f = 0; f < surface.elementCount(); ++f) {
      EXPECT_TRUE(surface.evaluate(f, at, Order::kEnergy, local));
      sum += local.energy;
    }
    return sum;
  }

  Eigen::VectorXd gradient(const Eigen::VectorXd& at) const {
    LocalEnergy local;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(at.size());
    for (int f = 0; f < surface.elementCount(); ++f) {
      EXPECT_TRUE(surface.evaluate(f, at, Order::kGradient, local));
      const std::vector<int>& entries = surface.entries(f);
      for (std::size_t i = 0; i < entries.size(); ++i) sum[entries[i]] += local.gradient[i];
    }
    return sum;
  }

  LayeredBody<Dim> body;
  SurfaceTension<Dim> surface;
};

/// Both dimensions, curved and flat facets.
template <int Dim, ElementKind Kind>
struct Case {
  static constexpr int kDim = Dim;
  static constexpr ElementKind kKind = Kind;
  static constexpr bool kCurved = Kind == ElementKind::kP2 || Kind == ElementKind::kP2P0 || Kind == ElementKind::kP2P1;
  using Problem = TensionProblem<Dim>;
  using Vector = typename Problem::Vector;
};

template <typename Case>
class SurfaceTensionTest : public testing::Test {};

using TensionCases = testing::Types<Case<2, ElementKind::kP1>, Case<2, ElementKind::kP2P1>, Case<3, ElementKind::kP1>,
                                    Case<3, ElementKind::kMini>, Case<3, ElementKind::kP2>>;
TYPED_TEST_SUITE(SurfaceTensionTest, TensionCases);

TYPED_TEST(SurfaceTensionTest, DerivativesAreThoseOfTheEnergy) {
  for (int layer : {0, 1}) {
    const typename TypeParam::Problem problem(TypeParam::kKind, 1, layer);
    const Eigen::VectorXd state = problem.random(0.02 * kTenseRadii[layer]);
    const double step = 1e-5 * kTenseRadii[layer];
    for (int f = 0; f < problem.surface.elementCount(); ++f) {
      const std::vector<int>& entries = problem.surface.entries(f);
      EXPECT_EQ(std::set<int>(entries.begin(), entries.end()).size(), entries.size());
    }
    EXPECT_EQ(expectDerivatives(problem.surface, state, step, 1e-7), problem.surface.elementCount());
  }
}

TYPED_TEST(SurfaceTensionTest, UndeformedIsAtEquilibriumWithoutEnergy) {
  const typename TypeParam::Problem problem(TypeParam::kKind);
  const Eigen::VectorXd at = Eigen::VectorXd::Zero(problem.body.stateSize());
  EXPECT_EQ(problem.energy(at), 0);
  EXPECT_EQ(problem.gradient(at).norm(), 0);
  EXPECT_EQ(problem.surface.pressure(), 2 * kTension / kTenseRadii[0]);
}

TYPED_TEST(SurfaceTensionTest, AreaAndVolumeConvergeToTheSphere) {
  for (int layer : {0, 1}) {
    const double R = kTenseRadii[layer], area = 4 * M_PI * R * R;
    double last[2] = {0, 0};
    for (int fineness : {1, 2, 4}) {
      const typename TypeParam::Problem problem(TypeParam::kKind, fineness, layer);
      const Eigen::VectorXd at = Eigen::VectorXd::Zero(problem.body.stateSize());
      const double errors[2] = {std::abs(problem.surface.area(at) / area - 1),
                                std::abs(problem.surface.enclosedVolume(at) / (area * R / 3) - 1)};
      for (int i = 0; i < 2; ++i) {
        if (fineness > 1) {
          EXPECT_NEAR(std::log2(last[i] / errors[i]), TypeParam::kCurved ? 4 : 2, 0.3) << errors[i];
        }
        last[i] = errors[i];
      }
      EXPECT_LT(errors[1], TypeParam::kCurved ? 0.03 : 0.3);
    }
  }
}

/// Discretisation errors of the finest test meshes, relative.
template <typename Case>
constexpr double kMeshError = Case::kDim == 2 ? (Case::kCurved ? 1e-6 : 6e-3) : (Case::kCurved ? 2e-4 : 6e-2);

TYPED_TEST(SurfaceTensionTest, InflationHasTheEnergyOfTheSphere) {
  const typename TypeParam::Problem problem(TypeParam::kKind, 4);
  for (double stretch : {0.8, 1.1, 1.3}) {
    const Eigen::VectorXd at = problem.state([&](const auto& X) { return typename TypeParam::Vector(stretch * X); });
    const double expected = kTension * kSphere * (std::pow(stretch, 2) - 1 - 2.0 / 3 * (std::pow(stretch, 3) - 1));
    EXPECT_NEAR(problem.energy(at) / expected, 1, kMeshError<TypeParam>);
  }
}

/// Spheroid of half axes a R, a R, c R with c > a: area and volume are known.
TYPED_TEST(SurfaceTensionTest, StretchHasTheEnergyOfTheSpheroid) {
  const double a = 0.9, c = 1.2;
  const double e = std::sqrt(1 - a * a / (c * c)), area = (a * a + a * c * std::asin(e) / e) / 2;
  const double expected = kTension * kSphere * (area - 1 - 2.0 / 3 * (a * a * c - 1));
  const typename TypeParam::Problem problem(TypeParam::kKind, 4);
  const Eigen::VectorXd at = problem.state([&](typename TypeParam::Vector X) {
    X *= a;
    X[TypeParam::kDim - 1] *= c / a;
    return X;
  });
  EXPECT_NEAR(problem.surface.area(at) / kSphere / area, 1, kMeshError<TypeParam>);
  EXPECT_NEAR(problem.energy(at) / expected, 1, kMeshError<TypeParam>);
}

/// A dead load has no resultant; of a shift along z (in space in any direction) nothing remains.
TYPED_TEST(SurfaceTensionTest, TranslationLeavesTheEnergy) {
  const typename TypeParam::Problem problem(TypeParam::kKind);
  typename TypeParam::Vector shift = TypeParam::Vector::Zero();
  shift[TypeParam::kDim - 1] = 0.7 * kTenseRadii[0];
  if (TypeParam::kDim == 3) shift[0] = -0.4 * kTenseRadii[0];
  const Eigen::VectorXd at = problem.state([&](const auto& X) { return typename TypeParam::Vector(X + shift); });
  EXPECT_NEAR(problem.energy(at) / (kTension * kSphere), 0, 1e-13);
  EXPECT_LT(problem.gradient(at).norm(), 1e-12 * kTension * kTenseRadii[0]);
}

/// Area and volume are left exactly; what remains is the work of the dead load, which does not turn along.
TEST(SurfaceTension, RotationLeavesTheEnergyButForTheDeadLoad) {
  const Eigen::Matrix3d Q = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (ElementKind kind : {ElementKind::kP1, ElementKind::kP2}) {
    double last = 0;
    for (int fineness : {1, 2, 4}) {
      const TensionProblem<3> problem(kind, fineness);
      const Eigen::VectorXd at = problem.state([&](const Eigen::Vector3d& X) { return Eigen::Vector3d(Q * X); });
      const Eigen::VectorXd none = Eigen::VectorXd::Zero(at.size());
      EXPECT_NEAR(problem.surface.area(at) / problem.surface.area(none), 1, 1e-13);
      EXPECT_NEAR(problem.surface.enclosedVolume(at) / problem.surface.enclosedVolume(none), 1, 1e-13);
      const double remains = std::abs(problem.energy(at)) / (kTension * kSphere);
      if (fineness > 1) {
        EXPECT_LT(remains, last / (kind == ElementKind::kP2 ? 12 : 3));
      }
      last = remains;
    }
    EXPECT_LT(last, kind == ElementKind::kP2 ? 1e-4 : 1e-2);
  }
}

TEST(SurfaceTension, SectionAndSpaceAgree) {
  // An egg: not symmetric in z.
  const double R = kTenseRadii[0];
  const auto stretch = [R](double z) { return 1 + 0.2 * z / R - 0.15 * z * z / (R * R); };
  for (int layer : {0, 1}) {
    const TensionProblem<2> section(ElementKind::kP2, 4, layer);
    const TensionProblem<3> space(ElementKind::kP2, 4, layer);
    const Eigen::VectorXd in_section = section.state([&](const Eigen::Vector2d& X) {
      return Eigen::Vector2d(stretch(X[1]) * X[0], 1.1 * X[1] + 0.1 * X[0] * X[0] / R);
    });
    const Eigen::VectorXd in_space = space.state([&](const Eigen::Vector3d& X) {
      const double r2 = X.head<2>().squaredNorm();
      return Eigen::Vector3d(stretch(X[2]) * X[0], stretch(X[2]) * X[1], 1.1 * X[2] + 0.1 * r2 / R);
    });
    EXPECT_NEAR(space.surface.area(in_space) / section.surface.area(in_section), 1, 1e-4);
    EXPECT_NEAR(space.surface.enclosedVolume(in_space) / section.surface.enclosedVolume(in_section), 1, 1e-4);
    EXPECT_NEAR(space.energy(in_space) / section.energy(in_section), 1, 1e-3);
  }
}

TYPED_TEST(SurfaceTensionTest, AFacetWithoutAreaHasNoEnergy) {
  const typename TypeParam::Problem problem(TypeParam::kKind);
  const Eigen::VectorXd collapsed =
      problem.state([](const auto&) { return typename TypeParam::Vector(TypeParam::Vector::Zero()); });
  LocalEnergy local;
  EXPECT_FALSE(problem.surface.evaluate(0, collapsed, Order::kHessian, local));
  if (TypeParam::kDim == 3) return;
  const Eigen::VectorXd crossed = problem.state([](typename TypeParam::Vector X) {
    X[0] *= -1;
    return X;
  });
  EXPECT_FALSE(problem.surface.evaluate(0, crossed, Order::kEnergy, local));
}

TYPED_TEST(SurfaceTensionTest, RefusesWhatItCannotBe) {
  const auto body = ball<TypeParam::kDim>(TypeParam::kKind, 1);
  using Surface = SurfaceTension<TypeParam::kDim>;
  EXPECT_THROW(Surface(body, 2, kTenseRadii[0], kTension), std::invalid_argument);
  EXPECT_THROW(Surface(body, 0, 0, kTension), std::invalid_argument);
  EXPECT_THROW(Surface(body, 0, kTenseRadii[0], -kTension), std::invalid_argument);
  EXPECT_THROW(Surface(body, 0, kTenseRadii[0], std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

/// A hole of 2 um through both layers.
TEST(PiercedSurfaceTension, DerivativesAreThoseOfTheEnergyAndTheHoleIsMissing) {
  PiercedSectionConfig section;
  section.radii = kTenseRadii;
  section.hole_radius = 2e-6;
  section.hole_length = 40e-6;
  MaterialConfig config;
  config.model = "neo_hookean";
  const LayeredBody<2> body(makePiercedSection(section), ElementKind::kP2P0,
                            LayeredBody<2>::Materials(2, std::shared_ptr<const Material>(makeMaterial(config))));
  for (const int layer : {0, 1}) {
    const double radius = kTenseRadii[layer], cap = 2 * M_PI * radius * (radius - std::sqrt(radius * radius - 4e-12));
    const SurfaceTension<2> surface(body, layer, radius, kTension);
    double energy = 0;
    LocalEnergy local;
    const Eigen::VectorXd undeformed = Eigen::VectorXd::Zero(body.stateSize());
    for (int i = 0; i < surface.elementCount(); ++i) {
      ASSERT_TRUE(surface.evaluate(i, undeformed, Order::kEnergy, local));
      energy += local.energy;
    }
    EXPECT_NEAR(energy, -kTension * cap, 0.02 * kTension * cap) << layer;
    const double ball = 4 * M_PI / 3 * std::pow(radius, 3), length = 40e-6 - (kTenseRadii[0] - radius);
    const double hole = M_PI * 4e-12 * (length - cap / (2 * M_PI * radius)) + M_PI * 4e-12 * cap / (4 * M_PI * radius);
    EXPECT_NEAR(ball - surface.enclosedVolume(undeformed), hole, 0.02 * hole) << "p0 acts on the wall, too";
    EXPECT_NEAR(surface.area(undeformed), 4 * M_PI * radius * radius - cap, 1e-5 * 4 * M_PI * radius * radius);
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> entry(-0.1e-6, 0.1e-6);
    const Eigen::VectorXd state = Eigen::VectorXd::NullaryExpr(body.stateSize(), [&] { return entry(generator); });
    EXPECT_GT(expectDerivatives(surface, state, 1e-10, 1e-5), 10);
  }
}

}  // namespace
}  // namespace microinjection
