#include "cell/tensegrity/tensegrity_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/errors.h"

namespace microinjection {
namespace {

using Kind = TensegrityGeometry::Kind;

TensegrityConfig prestressed(double actin, double intermediate) {
  TensegrityConfig config;
  config.actin.prestrain = actin;
  config.intermediate.prestrain = intermediate;
  return config;
}

TEST(TensegrityGeometry, HasTheMembersOfThePaper) {
  const TensegrityGeometry geometry(prestressed(0.05, 0.05));
  std::map<Kind, int> kinds;
  std::map<int, int> actin_at, intermediate_at;
  std::set<std::set<int>> pairs;
  for (const auto& cable : geometry.cables) {
    ++kinds[cable.kind];
    for (const int end : {cable.a, cable.b}) ++(cable.kind == Kind::kActin ? actin_at : intermediate_at)[end];
    pairs.insert({cable.a, cable.b});
  }
  EXPECT_EQ(kinds[Kind::kActin], 24);
  EXPECT_EQ(kinds[Kind::kSide] + kinds[Kind::kDiagonal], 12);
  EXPECT_EQ(pairs.size(), 36u);
  for (int end = 0; end < 12; ++end) {
    EXPECT_EQ(actin_at[end], 4);
    EXPECT_EQ(intermediate_at[end], 2);
  }
  EXPECT_EQ(geometry.triangles.size(), 20u);
}

TEST(TensegrityGeometry, EndsLieOnTheSphereTwoStrutsInEachDirection) {
  for (const std::string& orientation : tensegrityOrientations()) {
    TensegrityConfig config = prestressed(0.05, 0.05);
    config.orientation = orientation;
    const TensegrityGeometry geometry(config);
    for (const auto& end : geometry.ends) EXPECT_NEAR(end.norm() / config.radius, 1, 1e-12);
    for (int i = 0; i < 6; ++i) {
      const Eigen::Vector3d strut = geometry.ends[2 * i + 1] - geometry.ends[2 * i];
      EXPECT_NEAR(strut.norm() / geometry.strut_length, 1, 1e-12);
      for (int j = 0; j < i; ++j) {
        const Eigen::Vector3d other = geometry.ends[2 * j + 1] - geometry.ends[2 * j];
        const double cosine = strut.dot(other) / strut.norm() / other.norm();
        EXPECT_NEAR(cosine, i / 2 == j / 2 ? 1 : 0, 1e-12);
      }
    }
    for (int end = 0; end < 12; ++end) {
      const bool held = std::count(geometry.held.begin(), geometry.held.end(), end) > 0;
      for (const int lowest : geometry.held) {
        if (!held) EXPECT_GE(geometry.ends[end].z(), geometry.ends[lowest].z() - 1e-12);
      }
    }
  }
}

/// The known result for the expanded octahedron whose 24 cables alone pull: L = 2 s, cables of sqrt(3/8) L, and struts
/// that bear sqrt(6) times a cable's tension.
TEST(TensegrityGeometry, IsTheExpandedOctahedronWhereOnlyActinPulls) {
  const TensegrityConfig config = prestressed(0.05, 0);
  const TensegrityGeometry geometry(config);
  EXPECT_NEAR(geometry.strut_length / geometry.strut_distance, 2, 1e-12);
  for (int i = 0; i < 24; ++i) {
    EXPECT_NEAR(geometry.cables[i].length / geometry.strut_length, std::sqrt(3.0 / 8), 1e-12);
  }
  EXPECT_NEAR(geometry.strut_force / config.actin.tension(), std::sqrt(6.0), 1e-12);
}

/// Each end is in balance under the tensions and the struts' compression, with intermediate filaments, too.
TEST(TensegrityGeometry, EveryEndIsInBalance) {
  for (const double intermediate : {0.0, 0.05, 0.3}) {
    const TensegrityConfig config = prestressed(0.05, intermediate);
    const TensegrityGeometry geometry(config);
    std::array<Eigen::Vector3d, 12> forces;
    forces.fill(Eigen::Vector3d::Zero());
    const auto pull = [&](int a, int b, double tension) {
      const Eigen::Vector3d direction = (geometry.ends[b] - geometry.ends[a]).normalized();
      forces[a] += tension * direction;
      forces[b] -= tension * direction;
    };
    for (const auto& cable : geometry.cables) {
      const CableConfig& kind = cable.kind == Kind::kActin ? config.actin : config.intermediate;
      const double stiffness = kind.filaments.axialStiffness() / cable.rest_length;
      EXPECT_NEAR(cable.tension, stiffness * (cable.length - cable.rest_length), 1e-12 * stiffness * cable.length);
      EXPECT_NEAR(cable.length / (geometry.ends[cable.a] - geometry.ends[cable.b]).norm(), 1, 1e-12);
      pull(cable.a, cable.b, cable.tension);
    }
    for (const auto& [a, b] : geometry.struts) pull(a, b, -geometry.strut_force);
    for (const Eigen::Vector3d& force : forces) EXPECT_LT(force.norm(), 1e-12 * config.actin.tension());
  }
}

TEST(TensegrityGeometry, WithoutPrestressItIsThatOfASmallOne) {
  const TensegrityGeometry none(prestressed(0, 0)), small(prestressed(1e-9, 0));
  for (int i = 0; i < 12; ++i) EXPECT_LT((none.ends[i] - small.ends[i]).norm(), 1e-12 * 28e-6);
  EXPECT_EQ(none.strut_force, 0);
}

TEST(TensegrityConfig, NamesAllThatIsWrongAtOnce) {
  TensegrityConfig config;
  EXPECT_TRUE(config.errors().empty());
  config.orientation = "upside";
  config.actin.prestrain = -1;
  config.intermediate.prestrain = 0;
  config.microtubules.filaments.count = 0;
  config.microtubules.slices = 3;
  config.microtubules.model = "rubber";
  config.membrane.thickness = 0;
  config.cut = {36};
  EXPECT_EQ(config.errors().size(), 7u);
  EXPECT_THROW(config.validate(), ConfigError);
}

/// Parallel struts are drawn together by the intermediate filaments, and held apart by actin alone.
TEST(TensegrityConfig, RefusesIntermediateFilamentsThatNothingBalances) {
  EXPECT_FALSE(prestressed(0, 0.05).errors().empty());
  EXPECT_FALSE(prestressed(0.001, 0.05).errors().empty());
  EXPECT_TRUE(prestressed(0, 0).errors().empty());
}

/// Table II gives the radii that are known: 12 nm (microtubule), 2 to 3 nm (actin).
TEST(TensegrityConfig, SectionsFollowFromTheBendingStiffness) {
  const TensegrityConfig config;
  const FilamentConfig& tubule = config.microtubules.filaments;
  EXPECT_NEAR(tubule.filamentRadius(), 12.9e-9, 0.1e-9);
  EXPECT_NEAR(config.actin.filaments.filamentRadius(), 2.6e-9, 0.1e-9);
  const double r = tubule.filamentRadius();
  EXPECT_NEAR(tubule.young_modulus * M_PI * std::pow(r, 4) / 4 / 2.6e-23, 1, 1e-12);
  FilamentConfig bundle = tubule;
  bundle.count = 10;
  EXPECT_NEAR(bundle.axialStiffness() / tubule.axialStiffness(), 10, 1e-12);
  EXPECT_NEAR(bundle.young_modulus * M_PI * std::pow(bundle.radius(), 4) / 4 / bundle.bendingStiffness(), 1, 1e-12);
  EXPECT_NEAR(bundle.looseBendingStiffness() / tubule.bendingStiffness(), 10, 1e-12);
}

}  // namespace
}  // namespace microinjection
