#include "cell/tensegrity/membrane.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <set>

#include "cell/mechanics/term_derivatives.h"
#include "cell/tensegrity/geodesic_sphere.h"
#include "cell/tensegrity/tensegrity_geometry.h"

namespace microinjection {
namespace {

constexpr double kRadius = 28e-6;

struct Ball {
  explicit Ball(int divisions, const MembraneConfig& config)
      : geometry(makeGeometry(divisions)),
        places(std::make_shared<NodePositions>(geometry.rest)),
        zero(Eigen::VectorXd::Zero(3 * geometry.rest.size() + 3)),
        membrane(places, geometry, config, zero) {}

  static Membrane::Geometry makeGeometry(int divisions) {
    const TensegrityGeometry structure{TensegrityConfig()};
    const GeodesicSphere sphere({structure.ends.begin(), structure.ends.end()}, structure.triangles, divisions);
    Membrane::Geometry result;
    for (std::size_t i = 0; i < sphere.vertices.size(); ++i) result.nodes.push_back(static_cast<int>(i));
    result.rest = sphere.vertices;
    result.triangles = sphere.triangles;
    result.radius = kRadius;
    return result;
  }
  Eigen::VectorXd inflated(double stretch) const {
    Eigen::VectorXd state = zero;
    for (std::size_t i = 0; i < geometry.rest.size(); ++i) state.segment<3>(3 * i) = (stretch - 1) * geometry.rest[i];
    return state;
  }
  double energy(const Eigen::VectorXd& state) const {
    LocalEnergy local;
    double sum = 0;
    for (int f = 0; f < membrane.elementCount(); ++f) {
      membrane.evaluate(f, state, Order::kEnergy, local);
      sum += local.energy;
    }
    return sum;
  }

  Membrane::Geometry geometry;
  std::shared_ptr<NodePositions> places;
  Eigen::VectorXd zero;
  Membrane membrane;
};

TEST(GeodesicSphere, IsClosedOnTheSphereWithTheStrutEndsFirst) {
  for (const int divisions : {1, 2, 5}) {
    const Membrane::Geometry sphere = Ball::makeGeometry(divisions);
    EXPECT_EQ(sphere.rest.size(), 10u * divisions * divisions + 2);
    EXPECT_EQ(sphere.triangles.size(), 20u * divisions * divisions);
    std::set<std::pair<int, int>> edges;
    double volume = 0;
    for (const auto& t : sphere.triangles) {
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(edges.insert({t[k], t[(k + 1) % 3]}).second);
      volume += sphere.rest[t[0]].dot(sphere.rest[t[1]].cross(sphere.rest[t[2]])) / 6;
    }
    for (const auto& [a, b] : edges) EXPECT_EQ(edges.count({b, a}), 1u);
    EXPECT_GT(volume, 0);
    for (const auto& vertex : sphere.rest) EXPECT_NEAR(vertex.norm() / kRadius, 1, 1e-12);
  }
}

TEST(Membrane, DerivativesAreThoseOfTheEnergy) {
  MembraneConfig config;
  config.retardation_time = 0.2;
  Ball ball(2, config);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> entry(-2e-6, 2e-6);
  const auto random = [&] {
    return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(ball.zero.size(), [&] { return entry(generator); }));
  };
  ball.membrane.beginStep(0.1);
  ball.membrane.accept(random());
  for (const double duration : {0.05, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(ball.membrane.beginStep(duration), std::isfinite(duration));
    expectDerivatives(ball.membrane, random(), 1e-10, 1e-6);
  }
}

/// Inflated by a stretch s: E = (s^2 - 1) / 2 both ways, energy A (h E_young / (1 - nu) E^2 + 2 gamma E) - p V (s^3 -
/// 1).
TEST(Membrane, InflationHasTheEnergyOfTheSphere) {
  MembraneConfig config;
  Ball ball(16, config);
  const double area = 4 * M_PI * kRadius * kRadius, volume = area * kRadius / 3;
  const double pressure = 2 * config.tension / kRadius;
  const double modulus = config.thickness * config.young_modulus / (1 - config.poisson_ratio);
  for (const double stretch : {0.9, 1.2}) {
    const double strain = (stretch * stretch - 1) / 2;
    const double expected = area * (modulus * strain * strain + 2 * config.tension * strain) -
                            pressure * volume * (std::pow(stretch, 3) - 1);
    EXPECT_NEAR((ball.energy(ball.inflated(stretch)) - ball.energy(ball.zero)) / expected, 1, 0.01);
  }
}

/// Laplace: on a fine mesh, tension and pressure leave no force to speak of.
TEST(Membrane, TensionAndPressureAreInBalance) {
  double last = 0;
  for (const int divisions : {8, 16}) {
    MembraneConfig config;
    Ball ball(divisions, config);
    Eigen::VectorXd force = ball.zero;
    LocalEnergy local;
    for (int f = 0; f < ball.membrane.elementCount(); ++f) {
      ball.membrane.evaluate(f, ball.zero, Order::kGradient, local);
      for (int i = 0; i < 9; ++i) force[ball.membrane.entries(f)[i]] += local.gradient[i];
    }
    const double nodal = 4 * M_PI * kRadius * kRadius / ball.geometry.rest.size() * 2 * config.tension / kRadius;
    const double part = force.norm() / std::sqrt(ball.geometry.rest.size()) / nodal;
    if (divisions == 16) EXPECT_LT(part, 0.05);
    if (divisions == 16) EXPECT_LT(part, 0.75 * last);
    last = part;
  }
}

}  // namespace
}  // namespace microinjection
