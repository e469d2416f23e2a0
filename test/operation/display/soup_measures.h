#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "operation/display/triangle_soup.h"

namespace microinjection {

/// Volume inside a closed soup by the divergence theorem; negative when its triangles face inwards.
inline double signedVolume(const TriangleSoup& soup) {
  double volume = 0;
  for (std::size_t i = 0; i < soup.points.size(); i += 3) {
    volume += soup.points[i].dot(soup.points[i + 1].cross(soup.points[i + 2])) / 6;
  }
  return volume;
}

/// True when every edge is walked as often one way as the other.
inline bool isClosed(const TriangleSoup& soup) {
  const auto key = [](const Eigen::Vector3d& p) {
    return std::make_tuple(std::lround(p.x() * 1e9), std::lround(p.y() * 1e9), std::lround(p.z() * 1e9));
  };
  std::map<decltype(std::make_pair(key({}), key({}))), int> balance;
  for (std::size_t i = 0; i < soup.points.size(); i += 3) {
    for (int j = 0; j < 3; ++j) {
      const auto from = key(soup.points[i + j]), to = key(soup.points[i + (j + 1) % 3]);
      ++balance[{from, to}];
      --balance[{to, from}];
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

/// Range of the distance from the z axis over the points between two heights.
struct RadialRange {
  double least = std::numeric_limits<double>::infinity();
  double largest = 0;
};

inline RadialRange radialRange(const TriangleSoup& soup, double low, double high) {
  RadialRange range;
  for (const Eigen::Vector3d& point : soup.points) {
    if (point.z() < low || point.z() > high) continue;
    range.least = std::min(range.least, point.head<2>().norm());
    range.largest = std::max(range.largest, point.head<2>().norm());
  }
  return range;
}

/// Area of a regular polygon over that of its circumscribed circle.
inline double polygonFactor(int sides) { return sides / (2 * M_PI) * std::sin(2 * M_PI / sides); }

}  // namespace microinjection
