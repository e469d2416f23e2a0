#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

constexpr double kLevel = -1;
constexpr ElementKind kElement = ElementKind::kP2P0;

Scene discBesideTheAxis() {
  Scene scene;
  scene.needle.offset = {9e-6, 0};
  return scene;
}

/// What a disc takes with it does not leave the plane either.
TEST(MirrorSymmetry, HalfOfACellUnderADiscGivesTheForceOfTheWhole) {
  const Scene scene = discBesideTheAxis();
  const Eigen::Vector3d way(0.4e-6, 0, -0.6e-6);
  CellProblem<3> half(scene, makeHalfSceneMesh(scene, kLevel), kElement, Symmetry::kMirror);
  CellProblem<3> whole(scene, makeSceneMesh<3>(scene, kLevel), kElement);
  const IndentationSolution found = half.solve(way), expected = whole.solve(way);
  ASSERT_TRUE(found.converged && expected.converged) << found.reason << expected.reason;
  EXPECT_EQ(found.force.y(), 0);
  EXPECT_LT((found.force - expected.force).norm(), 0.01 * expected.force.norm());  // the whole mesh is not symmetric
  Eigen::Matrix3d in_plane = expected.stiffness;
  in_plane.row(1).setZero();
  in_plane.col(1).setZero();
  EXPECT_LT((found.stiffness - in_plane).norm(), 0.01 * in_plane.norm());
  const QuadraticMesh<3>& mesh = half.body().mesh();
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
    if (mesh.nodes[node].y() == 0) EXPECT_EQ(half.state()[3 * static_cast<Eigen::Index>(node) + 1], 0);
  }
}

TEST(MirrorSymmetry, RefusesWhatHasNone) {
  const Scene scene = discBesideTheAxis();
  CellProblem<3> half(scene, makeHalfSceneMesh(scene, kLevel), kElement, Symmetry::kMirror);
  EXPECT_THROW(half.solve({0, 1e-9, -1e-7}), std::invalid_argument);
  EXPECT_TRUE(half.solve({0, 0, -1e-7}).converged);
  EXPECT_THROW(CellProblem<3>(scene, makeSceneMesh<3>(scene, kLevel), kElement, Symmetry::kMirror),
               std::invalid_argument);
  Scene beside = scene;
  beside.needle.offset = {9e-6, 1e-7};
  EXPECT_THROW(CellProblem<3>(beside, makeHalfSceneMesh(scene, kLevel), kElement, Symmetry::kMirror),
               std::invalid_argument);
  EXPECT_THROW(makeHalfSceneMesh(beside, kLevel), std::invalid_argument);
  Scene axial = scene;
  axial.needle.offset.setZero();
  EXPECT_THROW(CellProblem<2>(axial, makeSceneMesh<2>(axial, kLevel), kElement, Symmetry::kMirror),
               std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
