#include "cell/mesh/outer_surface.h"

#include <algorithm>

namespace microinjection {

LayerSurface layerSurface(const QuadraticMesh<3>& mesh, int layer) {
  LayerSurface surface;
  std::vector<int>& nodes = surface.nodes;
  for (const auto& facet : mesh.facets) {
    if (facet.layer == layer) nodes.insert(nodes.end(), facet.nodes.begin(), facet.nodes.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto index = [&](int node) {
    return static_cast<int>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  for (const auto& facet : mesh.facets) {
    if (facet.layer != layer) continue;
    std::array<int, 6> f;
    std::transform(facet.nodes.begin(), facet.nodes.end(), f.begin(), index);
    const int m01 = f[3], m12 = f[4], m20 = f[5];  // see elementEdges
    for (const Eigen::Vector3i& t : {Eigen::Vector3i(f[0], m01, m20), Eigen::Vector3i(m01, f[1], m12),
                                     Eigen::Vector3i(m20, m12, f[2]), Eigen::Vector3i(m01, m12, m20)}) {
      surface.triangles.push_back(t);
    }
  }
  return surface;
}

std::vector<int> outerNodes(const QuadraticMesh<3>& mesh) { return layerSurface(mesh, 0).nodes; }

std::vector<Eigen::Vector3i> outerTriangles(const QuadraticMesh<3>& mesh) { return layerSurface(mesh, 0).triangles; }

}  // namespace microinjection
