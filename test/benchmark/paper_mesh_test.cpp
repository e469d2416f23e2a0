#include "benchmark/common/paper_mesh.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace microinjection {
namespace {

constexpr double kOff = 0.05;  ///< relative, that a mesh may be off the paper's size

struct Edges {
  double sum = 0;
  int count = 0;
  void add(double length) {
    sum += length;
    ++count;
  }
  double mean() const { return sum / count; }
};

/// Edges of tetrahedra with all corners in the ball about the needle, and of those with none.
std::pair<Edges, Edges> insideAndOutside(const TetMesh& mesh, const Eigen::Vector3d& centre, double radius) {
  Edges inside, outside;
  for (const auto& corners : mesh.tetrahedra) {
    int in = 0;
    for (const int v : corners) in += (mesh.vertices[v] - centre).norm() <= radius;
    if (in != 0 && in != 4) continue;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < a; ++b) {
        (in == 4 ? inside : outside).add((mesh.vertices[corners[a]] - mesh.vertices[corners[b]]).norm());
      }
    }
  }
  return {inside, outside};
}

TEST(PaperMesh, HasTheSizesOfTableThree) {
  const std::vector<std::pair<std::size_t, std::size_t>> paper = {{115, 332},  {123, 379},  {128, 407},  {165, 546},
                                                                  {176, 614},  {192, 672},  {271, 979},  {282, 1019},
                                                                  {346, 1269}, {516, 2130}, {731, 3060}, {1093, 4819}};
  ASSERT_EQ(paperMeshes().size(), paper.size());
  const Scene scene;
  for (std::size_t i = 0; i < paper.size(); ++i) {
    SCOPED_TRACE(std::to_string(paper[i].second) + " tetrahedra");
    const PaperMesh& mesh = paperMeshes()[i];
    EXPECT_EQ(mesh.vertices, paper[i].first);
    EXPECT_EQ(mesh.tetrahedra, paper[i].second);
    const PaperCell cell = makePaperCell(scene, mesh);
    EXPECT_NEAR(cell.mesh.vertices.size(), paper[i].first, kOff * paper[i].first);
    EXPECT_NEAR(cell.mesh.tetrahedra.size(), paper[i].second, kOff * paper[i].second);
    EXPECT_GE(cell.tip.size(), 1u);
    EXPECT_GE(cell.held.size(), 3u);
  }
}

TEST(PaperMesh, IsRefinedAboutTheNeedle) {
  const Scene scene;
  const double diameter = 2 * scene.needle.tip.radius, zone = 5 * diameter;
  for (const PaperMesh& mesh : paperMeshes()) {
    const PaperCell cell = makePaperCell(scene, mesh);
    const auto [inside, outside] = insideAndOutside(cell.mesh, scene.radius() * Eigen::Vector3d::UnitZ(), zone / 2);
    SCOPED_TRACE(std::to_string(mesh.tetrahedra) + " tetrahedra");
    EXPECT_NEAR(inside.mean(), mesh.size / 5, 0.4 * mesh.size / 5);
    // Not five times: elements grow with the distance, and the cell ends before they are as large as was asked for.
    EXPECT_GT(outside.mean(), 1.5 * inside.mean());
  }
}

}  // namespace
}  // namespace microinjection
