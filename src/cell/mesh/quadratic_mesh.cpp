#include "cell/mesh/quadratic_mesh.h"

#include <algorithm>
#include <map>
#include <utility>

namespace microinjection {
namespace {

template <int Dim>
using Simplices = std::vector<std::array<int, Dim + 1>>;

/// Edges whose midpoints follow the corners of a facet: (0, 1) on a section's arc, (0, 1), (1, 2),
/// (0, 2) in space.
template <int Dim>
const std::vector<std::array<int, 2>>& facetEdges() {
  static const std::vector<std::array<int, 2>> edges =
      Dim == 2 ? std::vector<std::array<int, 2>>{{0, 1}} : std::vector<std::array<int, 2>>{{0, 1}, {1, 2}, {0, 2}};
  return edges;
}

/// Creates the midpoint of each edge once.
template <int Dim>
class Midpoints {
 public:
  explicit Midpoints(QuadraticMesh<Dim>& mesh) : mesh_(mesh) {}

  int of(int a, int b) {
    const auto key = std::minmax(a, b);
    const auto [entry, added] = index_.try_emplace(key, static_cast<int>(mesh_.nodes.size()));
    if (added) mesh_.nodes.push_back(0.5 * (mesh_.nodes[a] + mesh_.nodes[b]));
    return entry->second;
  }

 private:
  QuadraticMesh<Dim>& mesh_;
  std::map<std::pair<int, int>, int> index_;
};

/// Faces of an element opposite to each corner, counter-clockwise seen from outside.
template <int Dim>
std::vector<std::array<int, Dim>> faces(const std::array<int, Dim + 1>& t) {
  if constexpr (Dim == 3) {
    return {{t[1], t[2], t[3]}, {t[0], t[3], t[2]}, {t[0], t[1], t[3]}, {t[0], t[2], t[1]}};
  } else {
    return {{t[1], t[2]}, {t[2], t[0]}, {t[0], t[1]}};
  }
}

template <int Dim>
bool onAxis(const QuadraticMesh<Dim>& mesh, const std::array<int, Dim>& face) {
  if (Dim == 3) return false;
  return std::all_of(face.begin(), face.end(), [&](int v) { return mesh.nodes[v][0] == 0; });
}

template <int Dim>
struct LayerSurface {
  std::array<int, Dim> face;
  int layer;
  bool outer;
};

/// Outer faces of the elements of each layer.
template <int Dim>
std::vector<LayerSurface<Dim>> layerSurfaces(const QuadraticMesh<Dim>& mesh, const Simplices<Dim>& elements) {
  struct Side {
    std::array<int, Dim> face;
    int layer;
    int inner = -1;  ///< layer on the other side
  };
  std::map<std::array<int, Dim>, std::vector<Side>> sides;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (const std::array<int, Dim>& face : faces<Dim>(elements[e])) {
      std::array<int, Dim> key = face;
      std::sort(key.begin(), key.end());
      sides[key].push_back({face, mesh.layers[e]});
    }
  }
  std::vector<LayerSurface<Dim>> surfaces;
  for (const auto& [key, pair] : sides) {
    if (pair.size() == 1 && !onAxis<Dim>(mesh, pair[0].face)) surfaces.push_back({pair[0].face, pair[0].layer, true});
    if (pair.size() == 2 && pair[0].layer != pair[1].layer) {
      const Side& inner = pair[0].layer > pair[1].layer ? pair[0] : pair[1];
      surfaces.push_back({inner.face, inner.layer, false});
    }
  }
  return surfaces;
}

template <int Dim>
QuadraticMesh<Dim> make(const std::vector<Eigen::Matrix<double, Dim, 1>>& vertices, const Simplices<Dim>& elements,
                        const std::vector<int>& layers, const std::vector<double>& radii) {
  QuadraticMesh<Dim> mesh;
  mesh.nodes = vertices;
  mesh.vertex_count = static_cast<int>(vertices.size());
  mesh.layers = layers.empty() ? std::vector<int>(elements.size(), 0) : layers;
  Midpoints<Dim> midpoints(mesh);
  for (const auto& corners : elements) {
    std::array<int, QuadraticMesh<Dim>::kNodes> nodes;
    std::copy(corners.begin(), corners.end(), nodes.begin());
    int next = Dim + 1;
    for (const auto& [a, b] : elementEdges<Dim>()) nodes[next++] = midpoints.of(corners[a], corners[b]);
    mesh.elements.push_back(nodes);
  }
  for (const auto& [corners, layer, outer] : layerSurfaces<Dim>(mesh, elements)) {
    typename QuadraticMesh<Dim>::Facet facet;
    facet.layer = layer;
    facet.outer = outer;
    std::copy(corners.begin(), corners.end(), facet.nodes.begin());
    int next = Dim;
    for (const auto& [a, b] : facetEdges<Dim>()) {
      const int middle = midpoints.of(corners[a], corners[b]);
      if (!radii.empty())
        mesh.nodes[middle] = radii[layer] * (mesh.nodes[corners[a]] + mesh.nodes[corners[b]]).normalized();
      facet.nodes[next++] = middle;
    }
    mesh.facets.push_back(facet);
  }
  return mesh;
}

}  // namespace

template <>
const std::vector<std::array<int, 2>>& elementEdges<2>() {
  static const std::vector<std::array<int, 2>> edges = {{0, 1}, {1, 2}, {0, 2}};
  return edges;
}

template <>
const std::vector<std::array<int, 2>>& elementEdges<3>() {
  static const std::vector<std::array<int, 2>> edges = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  return edges;
}

QuadraticMesh<3> makeQuadratic(const TetMesh& mesh, const std::vector<double>& radii) {
  return make<3>(mesh.vertices, mesh.tetrahedra, mesh.layers, radii);
}

QuadraticMesh<3> makeQuadratic(const TetMesh& mesh, const std::function<Eigen::Vector3d(int, int)>& middle) {
  QuadraticMesh<3> result = make<3>(mesh.vertices, mesh.tetrahedra, mesh.layers, {});
  for (const auto& nodes : result.elements) {
    int next = 4;
    for (const auto& [a, b] : elementEdges<3>()) result.nodes[nodes[next++]] = middle(nodes[a], nodes[b]);
  }
  return result;
}

QuadraticMesh<2> makeQuadratic(const TriangleMesh& mesh, const std::vector<double>& radii) {
  return make<2>(mesh.vertices, mesh.triangles, mesh.layers, radii);
}

}  // namespace microinjection
