#include "cell/surrogate/surface_grid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "cell/model/contact_frame.h"
#include "cell/model/scene_mesh.h"
#include "cell/surrogate/spring_cells.h"

namespace microinjection {
namespace {

TEST(SurfaceGrid, IsAClosedSphereSeenFromOutside) {
  const SurfaceGrid& grid = SurfaceGrid::standard();
  const Eigen::VectorXd nodes = grid.nodes(2, 0.7);
  double volume = 0;
  for (const Eigen::Vector3i& t : grid.triangles()) {
    const Eigen::Vector3d a = nodes.segment<3>(3 * t[0]), b = nodes.segment<3>(3 * t[1]),
                          c = nodes.segment<3>(3 * t[2]);
    const double piece = a.dot(b.cross(c)) / 6;
    EXPECT_GT(piece, 0);
    volume += piece;
  }
  const double ball = 4.0 / 3 * M_PI * 8;
  EXPECT_LT(volume, ball);
  EXPECT_GT(volume, 0.98 * ball);
}

TEST(SurfaceGrid, ItsFirstNodeIsTheContactPoint) {
  const Eigen::VectorXd nodes = SurfaceGrid::standard().nodes(3, 0.4);
  EXPECT_TRUE(nodes.head<3>().isApprox(3 * Eigen::Vector3d(std::sin(0.4), 0, std::cos(0.4)), 1e-12));
}

TEST(SurfaceGrid, MirroredNodesAreImages) {
  const SurfaceGrid& grid = SurfaceGrid::standard();
  const Eigen::VectorXd nodes = grid.nodes(1, 0.5);
  for (int n = 0; n < grid.nodeCount(); ++n) {
    const Eigen::Vector3d image = nodes.segment<3>(3 * n).cwiseProduct(Eigen::Vector3d(1, -1, 1));
    EXPECT_LT((nodes.segment<3>(3 * grid.mirrored()[n]) - image).norm(), 1e-12);
  }
}

/// Linear in the position, so that only the facets' flatness is left: that of wide ones on the far side.
TEST(GridInterpolation, ReproducesALinearMotionOnWholeAndHalfMeshes) {
  constexpr double kAngle = 0.6;
  Scene scene = pipette();
  scene.needle.offset = ContactFrame::offsetFor(scene, kAngle);
  const Eigen::Vector3d stretch(0.1, -0.05, 0.2);  // keeps the plane y = 0
  for (const bool half : {false, true}) {
    const QuadraticMesh<3> mesh = half ? makeHalfSceneMesh(scene, -1) : makeSceneMesh<3>(scene, -1);
    Eigen::VectorXd state(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      state.segment<3>(3 * static_cast<Eigen::Index>(n)) = stretch.cwiseProduct(mesh.nodes[n]);
    }
    const Eigen::VectorXf moved = GridInterpolation(mesh, kAngle, half).displacement(state);
    const Eigen::VectorXd rest = SurfaceGrid::standard().nodes(scene.radius(), kAngle);
    double worst = 0, near_tip = 0;
    for (Eigen::Index n = 0; n + 2 < rest.size(); n += 3) {
      const Eigen::Vector3d expected = stretch.cwiseProduct(rest.segment<3>(n));
      worst = std::max(worst, (moved.segment<3>(n).cast<double>() - expected).norm());
      if (n < 3 * 100) near_tip = worst;
    }
    EXPECT_LT(worst, 0.03 * stretch.norm() * scene.radius()) << half;
    EXPECT_LT(near_tip, 0.002 * stretch.norm() * scene.radius()) << half;
  }
}

}  // namespace
}  // namespace microinjection
