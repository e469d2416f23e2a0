#include "vision/microscope/specimen.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "vision/microscope/focus_axis.h"

namespace microinjection {
namespace {

constexpr double kRadius = 40e-6;  // m

/// A sphere about the world's origin: an octahedron whose faces are divided `times` times.
Specimen sphere(int times = 5) {
  Specimen specimen;
  specimen.radius = kRadius;
  std::vector<std::array<Eigen::Vector3d, 3>> faces;
  for (const int x : {-1, 1})
    for (const int y : {-1, 1})
      for (const int z : {-1, 1})
        faces.push_back({Eigen::Vector3d(x, 0, 0), Eigen::Vector3d(0, y, 0), Eigen::Vector3d(0, 0, z)});
  for (int i = 0; i < times; ++i) {
    std::vector<std::array<Eigen::Vector3d, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const Eigen::Vector3d ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = finer;
  }
  // A section joins triangles by their nodes: nodes at one place are one.
  for (const auto& face : faces) {
    std::array<int, 3> triangle{};
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d node = kRadius * face[i];
      const auto found = std::find_if(specimen.vertices.begin(), specimen.vertices.end(),
                                      [&](const Eigen::Vector3d& v) { return (v - node).norm() < 1e-6 * kRadius; });
      triangle[i] = static_cast<int>(found - specimen.vertices.begin());
      if (found == specimen.vertices.end()) specimen.vertices.push_back(node);
    }
    specimen.triangles.push_back(triangle);
  }
  return specimen;
}

double meanRadius(const CellOutline& outline) {
  double sum = 0;
  for (const Eigen::Vector2d& corner : outline) sum += corner.norm();
  return sum / static_cast<double>(outline.size());
}

TEST(SpecimenScene, HasTheLayersOfTheCell) {
  SpecimenConfig config;
  config.perivitelline_gap = 0.05;
  Specimen specimen = sphere();
  EXPECT_NEAR(meanRadius(specimenScene(config, specimen).cells.at(0).ooplasm), kRadius, 1e-3 * kRadius);
  EXPECT_TRUE(specimenScene(config, specimen).cells[0].zona_outer.empty());

  specimen.shell_thickness = 6e-6;
  const CellScene cell = specimenScene(config, specimen).cells.at(0);
  EXPECT_NEAR(meanRadius(cell.zona_outer), kRadius, 1e-3 * kRadius);
  EXPECT_NEAR(meanRadius(cell.zona_inner), kRadius - 6e-6, 1e-3 * kRadius);
  EXPECT_NEAR(meanRadius(cell.ooplasm), kRadius - 8e-6, 1e-3 * kRadius);
}

TEST(SpecimenScene, HasThePipettesWhereTheirFramesAre) {
  Specimen specimen = sphere();
  const double tilt = 0.3;
  Eigen::Isometry3d needle(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()));
  needle.translation() = Eigen::Vector3d(3e-6, 2e-6, 50e-6);
  specimen.needle = needle;
  Eigen::Isometry3d holder(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()));
  holder.translation() = Eigen::Vector3d(0, 0, -40e-6);
  specimen.holder = holder;
  const MicroscopeScene scene = specimenScene(SpecimenConfig(), specimen);
  EXPECT_TRUE(scene.injection->axis.isApprox(Eigen::Vector3d(std::sin(tilt), 0, std::cos(tilt))));
  EXPECT_EQ(scene.injection->tip, needle.translation());
  EXPECT_TRUE(scene.holding->axis.isApprox(Eigen::Vector2d(0, -1)));
  EXPECT_TRUE(scene.holding->mouth.isApprox(Eigen::Vector2d(0, -40e-6)));
  scene.validate();
}

TEST(SpecimenScene, LeavesOutAPipetteAlongTheLineOfSight) {
  Specimen specimen;
  specimen.needle = Eigen::Isometry3d(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX()));
  const MicroscopeScene scene = specimenScene(SpecimenConfig(), specimen);
  EXPECT_FALSE(scene.injection);
  EXPECT_TRUE(scene.cells.empty());
}

TEST(FocusAxis, MovesWithItsSpeedAndStopsAtTheGoal) {
  FocusAxis axis({{-50e-6, 50e-6}, 20e-6, 0});
  EXPECT_FALSE(axis.allows(51e-6));
  EXPECT_FALSE(axis.allows(std::nan("")));
  axis.moveTo(-30e-6);
  axis.step(0.5);
  EXPECT_NEAR(axis.position(), -10e-6, 1e-15);
  EXPECT_TRUE(axis.moving());
  axis.step(10);
  EXPECT_EQ(axis.position(), -30e-6);
  EXPECT_FALSE(axis.moving());
}

TEST(FocusAxis, RefusesAStartOutsideOfItsRange) {
  ConfigReader reader(YAML::Load("{range: [0, 1.0e-5], start: 2.0e-5}"), "test");
  FocusAxisConfig::read(reader);
  EXPECT_THROW(reader.finish(), ConfigError);
}

}  // namespace
}  // namespace microinjection
