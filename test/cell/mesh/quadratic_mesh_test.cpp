#include "cell/mesh/quadratic_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "cell/mesh/round_shapes.h"

namespace microinjection {
namespace {

const std::vector<double> kRadii = {1.5, 1.2, 0.7};  // m
constexpr int kLevel = 2, kArcs = 10;

template <int Dim>
struct Shape;
template <>
struct Shape<2> {
  static TriangleMesh linear() { return layeredHalfDisc(kArcs, kRadii); }
  static const auto& elements(const TriangleMesh& mesh) { return mesh.triangles; }
  static constexpr int kFacetsALayer = kArcs;
};
template <>
struct Shape<3> {
  static TetMesh linear() { return layeredBall(kLevel, kRadii); }
  static const auto& elements(const TetMesh& mesh) { return mesh.tetrahedra; }
  static constexpr int kFacetsALayer = 8 << (2 * kLevel);
};

template <typename Size>
class QuadraticMeshTest : public testing::Test {
 protected:
  static constexpr int kDim = Size::value;
  using Mesh = QuadraticMesh<kDim>;

  typename Mesh::Point middle(int a, int b) const { return (mesh_.nodes[a] + mesh_.nodes[b]) / 2; }

  const decltype(Shape<kDim>::linear()) linear_ = Shape<kDim>::linear();
  const Mesh mesh_ = makeQuadratic(linear_, kRadii);
};

using Sizes = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(QuadraticMeshTest, Sizes);

TYPED_TEST(QuadraticMeshTest, VerticesThenOneMidpointAnEdge) {
  const auto& mesh = this->mesh_;
  const auto& elements = Shape<TypeParam::value>::elements(this->linear_);
  ASSERT_EQ(mesh.vertex_count, static_cast<int>(this->linear_.vertices.size()));
  for (int v = 0; v < mesh.vertex_count; ++v) EXPECT_EQ(mesh.nodes[v], this->linear_.vertices[v]);
  std::set<std::pair<int, int>> edges;
  for (const auto& corners : elements) {
    for (const auto& [a, b] : elementEdges<TypeParam::value>()) edges.insert(std::minmax(corners[a], corners[b]));
  }
  EXPECT_EQ(mesh.nodes.size(), mesh.vertex_count + edges.size());
  EXPECT_EQ(mesh.layers, this->linear_.layers);
  ASSERT_EQ(mesh.elements.size(), elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    EXPECT_TRUE(std::equal(elements[e].begin(), elements[e].end(), mesh.elements[e].begin()));
  }
}

/// A midpoint lies on its own edge's chord, or above its middle on the sphere where both ends are on that sphere.
TYPED_TEST(QuadraticMeshTest, MidpointsLieOnChordsOrSpheres) {
  const auto& mesh = this->mesh_;
  int on_chord = 0, on_sphere = 0;
  for (const auto& nodes : mesh.elements) {
    int next = TypeParam::value + 1;
    for (const auto& [a, b] : elementEdges<TypeParam::value>()) {
      const auto chord = this->middle(nodes[a], nodes[b]);
      const auto at = mesh.nodes[nodes[next++]];
      const double ends[2] = {mesh.nodes[nodes[a]].norm(), mesh.nodes[nodes[b]].norm()};
      if (ends[1] > 0 && std::abs(ends[0] - ends[1]) < 1e-12) {
        EXPECT_LT((at - ends[0] * chord.normalized()).norm(), 1e-14);
        ++on_sphere;
      } else {
        EXPECT_EQ(at, chord);
        ++on_chord;
      }
    }
  }
  EXPECT_GT(on_chord, 0);
  EXPECT_GT(on_sphere, 0);
}

TYPED_TEST(QuadraticMeshTest, EachLayerHasItsWholeOuterSurface) {
  const auto& mesh = this->mesh_;
  std::vector<int> count(kRadii.size(), 0);
  for (const auto& facet : mesh.facets) {
    ASSERT_GE(facet.layer, 0);
    ASSERT_LT(facet.layer, static_cast<int>(kRadii.size()));
    ++count[facet.layer];
    for (int node : facet.nodes) EXPECT_NEAR(mesh.nodes[node].norm(), kRadii[facet.layer], 1e-14);
  }
  EXPECT_EQ(count, std::vector<int>(kRadii.size(), Shape<TypeParam::value>::kFacetsALayer));
}

TYPED_TEST(QuadraticMeshTest, AMeshWithoutLayersIsOneLayer) {
  auto linear = this->linear_;
  linear.layers.clear();
  const auto mesh = makeQuadratic(linear, {kRadii[0]});
  EXPECT_EQ(mesh.layers, std::vector<int>(mesh.elements.size(), 0));
  EXPECT_EQ(static_cast<int>(mesh.facets.size()), Shape<TypeParam::value>::kFacetsALayer);
}

TEST(QuadraticMesh, FacetsInSpaceGoCounterClockwiseSeenFromOutside) {
  const QuadraticMesh<3> mesh = makeQuadratic(Shape<3>::linear(), kRadii);
  const int edges[3][2] = {{0, 1}, {1, 2}, {0, 2}};
  for (const auto& facet : mesh.facets) {
    const Eigen::Vector3d a = mesh.nodes[facet.nodes[0]], b = mesh.nodes[facet.nodes[1]],
                          c = mesh.nodes[facet.nodes[2]];
    EXPECT_GT((b - a).cross(c - a).normalized().dot((a + b + c).normalized()), 0.9);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d chord = (mesh.nodes[facet.nodes[edges[i][0]]] + mesh.nodes[facet.nodes[edges[i][1]]]) / 2;
      EXPECT_LT((mesh.nodes[facet.nodes[3 + i]].normalized() - chord.normalized()).norm(), 1e-14);
    }
  }
}

TEST(QuadraticMesh, FacetsOfASectionGoUpItsArcs) {
  const QuadraticMesh<2> mesh = makeQuadratic(Shape<2>::linear(), kRadii);
  std::vector<double> rise(kRadii.size(), 0);
  for (const auto& facet : mesh.facets) {
    const Eigen::Vector2d a = mesh.nodes[facet.nodes[0]], b = mesh.nodes[facet.nodes[1]];
    EXPECT_LT(a[1], b[1]);
    EXPECT_LT((mesh.nodes[facet.nodes[2]].normalized() - (a + b).normalized()).norm(), 1e-14);
    rise[facet.layer] += b[1] - a[1];
  }
  for (std::size_t layer = 0; layer < kRadii.size(); ++layer) EXPECT_NEAR(rise[layer], 2 * kRadii[layer], 1e-14);
}

TEST(QuadraticMesh, MidpointsOnASectionsAxisStayOnIt) {
  const QuadraticMesh<2> mesh = makeQuadratic(Shape<2>::linear(), kRadii);
  const auto on_axis = std::count_if(mesh.nodes.begin(), mesh.nodes.end(), [](const auto& x) { return x[0] == 0; });
  EXPECT_EQ(on_axis, 4 * static_cast<int>(kRadii.size()) + 1);
  for (const auto& x : mesh.nodes) EXPECT_GE(x[0], 0);
}

}  // namespace
}  // namespace microinjection
