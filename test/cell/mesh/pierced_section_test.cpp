#include "cell/mesh/pierced_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

/// m^3, of the body of revolution of each layer's elements, by their corners.
std::vector<double> volumes(const QuadraticMesh<2>& mesh, std::size_t layers) {
  std::vector<double> result(layers, 0);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const auto at = [&](int corner) { return mesh.nodes[mesh.elements[e][corner]]; };
    const Eigen::Vector2d a = at(1) - at(0), b = at(2) - at(0);
    const double area = 0.5 * (a.x() * b.y() - a.y() * b.x());
    EXPECT_GT(area, 0);
    result[mesh.layers[e]] += 2 * M_PI * area * (at(0).x() + at(1).x() + at(2).x()) / 3;
  }
  return result;
}

double ball(double radius) { return 4 * M_PI / 3 * std::pow(radius, 3); }

PiercedSectionConfig shellOver(double hole_length) {
  PiercedSectionConfig config;
  config.radii = {28e-6, 22e-6};
  config.hole_radius = 2e-6;
  config.hole_length = hole_length;
  config.size = 2e-6;
  return config;
}

TEST(PiercedSection, AHoleTakesItsPartOfEachLayer) {
  const double hole_area = M_PI * 4e-12;
  for (const double length : {0.0, 4e-6, 15e-6}) {
    const std::vector<double> found = volumes(makePiercedSection(shellOver(length)), 2);
    const double outer = ball(28e-6) - ball(22e-6) - hole_area * std::min(length, 6e-6);
    const double inner = ball(22e-6) - hole_area * std::max(length - 6e-6, 0.0);
    EXPECT_NEAR(found[0], outer, 0.01 * outer) << length;
    EXPECT_NEAR(found[1], inner, 0.01 * inner) << length;
  }
}

TEST(PiercedSection, FacetsAreThoseOfTheSpheresAndOfTheHole) {
  const PiercedSectionConfig config = shellOver(15e-6);
  const QuadraticMesh<2> mesh = makePiercedSection(config);
  int wall = 0, border = 0;
  for (const auto& facet : mesh.facets) {
    const auto& middle = mesh.nodes[facet.nodes[2]];
    const bool on_sphere = std::abs(middle.norm() / config.radii[facet.layer] - 1) < 1e-9;
    if (!facet.outer) {
      EXPECT_EQ(facet.layer, 1);
      EXPECT_TRUE(on_sphere);
      ++border;
    } else if (!on_sphere) {
      EXPECT_TRUE(std::abs(middle.x() / 2e-6 - 1) < 1e-9 || std::abs(middle.y() - 13e-6) < 1e-12) << middle.transpose();
      ++wall;
    }
  }
  EXPECT_GT(border, 8);
  EXPECT_GT(wall, 8);
}

TEST(PiercedSection, TheRimCanBeRounded) {
  PiercedSectionConfig config = shellOver(15e-6);
  config.rim_radius = 1e-6;
  const QuadraticMesh<2> mesh = makePiercedSection(config);
  double highest = 0;
  for (const auto& node : mesh.nodes) {
    if (std::abs(node.x() / 2e-6 - 1) < 1e-9) highest = std::max(highest, node.y());
  }
  EXPECT_NEAR(highest, std::sqrt(27e-6 * 27e-6 - 9e-12), 1e-9) << "where the fillet touches the wall";
}

TEST(PiercedSection, NoHoleEndsAtABorder) {
  for (const double length : {5.9e-6, 6e-6, 6.09e-6}) EXPECT_THROW(makePiercedSection(shellOver(length)), ConfigError);
  EXPECT_THROW(makePiercedSection(shellOver(49e-6)), ConfigError) << "below the inner layer";
  PiercedSectionConfig config = shellOver(10e-6);
  config.radii = {22e-6, 28e-6};
  EXPECT_THROW(makePiercedSection(config), ConfigError);
}

}  // namespace
}  // namespace microinjection
