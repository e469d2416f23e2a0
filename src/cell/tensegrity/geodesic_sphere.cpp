#include "cell/tensegrity/geodesic_sphere.h"

#include <algorithm>
#include <map>

namespace microinjection {

GeodesicSphere::GeodesicSphere(const std::vector<Eigen::Vector3d>& corners,
                               const std::vector<std::array<int, 3>>& faces, int divisions)
    : vertices(corners) {
  // Key of a point: its weights (in 1/divisions) on the corners of its face, without zeros.
  // Adjacent faces share keys.
  std::map<std::vector<std::array<int, 2>>, int> numbers;
  const double radius = corners.front().norm();
  const auto vertex = [&](const std::array<int, 3>& face, int i, int j) {
    const std::array<int, 3> shares = {divisions - i - j, i, j};
    std::vector<std::array<int, 2>> key;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      if (shares[k] > 0) key.push_back({face[k], shares[k]});
    }
    std::sort(key.begin(), key.end());
    if (key.size() == 1) return key[0][0];
    for (const auto& [corner, share] : key) at += share * corners[corner];
    const auto [entry, added] = numbers.try_emplace(key, static_cast<int>(vertices.size()));
    if (added) vertices.emplace_back(radius / at.norm() * at);
    return entry->second;
  };
  for (const std::array<int, 3>& face : faces) {
    for (int i = 0; i < divisions; ++i) {
      for (int j = 0; i + j < divisions; ++j) {
        triangles.push_back({vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1)});
        if (i + j + 1 < divisions)
          triangles.push_back({vertex(face, i + 1, j), vertex(face, i + 1, j + 1), vertex(face, i, j + 1)});
      }
    }
  }
}

}  // namespace microinjection
