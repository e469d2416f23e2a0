#include "cell/mesh/tet_improvement.h"

#include <gtest/gtest.h>

#include "cell/mesh/shapes.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kMiddle(1. / 3, 1. / 3, 1. / 3);

/// The cube of 27 with one inner vertex pushed almost into a face of its star.
TetMesh spoiltCube(int& vertex) {
  TetMesh mesh = unitCube(3);
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    if ((mesh.vertices[v] - kMiddle).norm() < 1e-9) vertex = static_cast<int>(v);
  }
  mesh.vertices[vertex] += Eigen::Vector3d(0.1, -0.2, 0.25);
  return mesh;
}

TEST(TetImprovement, MovesFreeVerticesOnly) {
  int vertex = -1;
  TetMesh mesh = spoiltCube(vertex);
  const TetMesh before = mesh;
  std::vector<Mobility> mobility(mesh.vertices.size());
  improveWorstTetrahedra(mesh, mobility, 0.3);
  EXPECT_EQ(mesh.vertices, before.vertices);
  mobility[vertex].kind = Mobility::Kind::kFree;
  ASSERT_LT(worstRadiusRatio(before), 0.1);
  improveWorstTetrahedra(mesh, mobility, 0.3);
  EXPECT_GT(worstRadiusRatio(mesh), 0.3);
  EXPECT_EQ(mesh.tetrahedra, before.tetrahedra);
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    EXPECT_EQ(mesh.vertices[v] == before.vertices[v], static_cast<int>(v) != vertex);
  }
}

TEST(TetImprovement, KeepsVerticesOnTheirSphere) {
  int vertex = -1;
  TetMesh mesh = spoiltCube(vertex);
  const TetMesh before = mesh;
  const double radius = kMiddle.norm();
  mesh.vertices[vertex] *= radius / mesh.vertices[vertex].norm();
  std::vector<Mobility> mobility(mesh.vertices.size());
  mobility[vertex] = {Mobility::Kind::kOnSphere, radius};
  const double worst = worstRadiusRatio(mesh);
  improveWorstTetrahedra(mesh, mobility, 0.4);
  EXPECT_GT(worstRadiusRatio(mesh), worst + 0.05);
  EXPECT_NEAR(mesh.vertices[vertex].norm(), radius, 1e-15);
}

TEST(TetImprovement, LeavesAGoodMeshAsItIs) {
  TetMesh mesh = unitCube(2);
  const TetMesh before = mesh;
  improveWorstTetrahedra(mesh, std::vector<Mobility>(mesh.vertices.size(), {Mobility::Kind::kFree, 0}), 0.2);
  EXPECT_EQ(mesh.vertices, before.vertices);
}

}  // namespace
}  // namespace microinjection
