#include "operation/display/section_cut.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <utility>

#include "operation/display/polygon_triangles.h"

namespace microinjection {
namespace {

struct Corner {
  Eigen::Vector3d point;
  Colour colour;
};

Corner between(const Corner& a, const Corner& b, double share) {
  const auto mixed = [share](float from, float to) { return static_cast<float>(from + share * (to - from)); };
  return {a.point + share * (b.point - a.point),
          {mixed(a.colour.r, b.colour.r), mixed(a.colour.g, b.colour.g), mixed(a.colour.b, b.colour.b),
           mixed(a.colour.a, b.colour.a)}};
}

/// The part of a triangle below the plane, with up to four corners.
std::vector<Corner> clipped(const std::array<Corner, 3>& triangle, const CutPlane& plane) {
  std::vector<Corner> result;
  for (int i = 0; i < 3; ++i) {
    const Corner &a = triangle[i], &b = triangle[(i + 1) % 3];
    const double ha = plane.height(a.point), hb = plane.height(b.point);
    if (ha <= 0) result.push_back(a);
    if ((ha <= 0) != (hb <= 0)) result.push_back(between(a, b, ha / (ha - hb)));
  }
  return result;
}

double length(const std::vector<Eigen::Vector3d>& curve) {
  double sum = 0;
  for (std::size_t i = 0; i < curve.size(); ++i) sum += (curve[(i + 1) % curve.size()] - curve[i]).norm();
  return sum;
}

using Edge = std::pair<int, int>;
Edge edgeOf(int a, int b) { return std::minmax(a, b); }

/// For each edge that crosses the plane upwards in its triangle: where the plane leaves that triangle.
std::map<Edge, Edge> crossings(const std::vector<double>& heights, const std::vector<std::array<int, 3>>& triangles) {
  std::map<Edge, Edge> next;
  for (const auto& triangle : triangles) {
    Edge in, out;
    bool crossed = false;
    for (int i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      if ((heights[a] <= 0) == (heights[b] <= 0)) continue;
      crossed = true;
      (heights[a] <= 0 ? in : out) = edgeOf(a, b);
    }
    if (crossed) next[in] = out;
  }
  return next;
}

}  // namespace

CutPlane CutPlane::along(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d viewer = -Eigen::Vector3d::UnitY();
  const Eigen::Vector3d across = viewer - viewer.dot(axis) * axis;
  return {point, across.norm() > 1e-3 ? across.normalized() : axis.unitOrthogonal()};
}

TriangleSoup remains(const TriangleSoup& soup, const CutPlane& plane) {
  TriangleSoup result;
  for (std::size_t i = 0; i + 2 < soup.points.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return Corner{soup.points[i + k], soup.colours[i + k]}; };
    const std::vector<Corner> rest = clipped({corner(0), corner(1), corner(2)}, plane);
    for (std::size_t k = 1; k + 1 < rest.size(); ++k) {
      result.add(rest[0].point, rest[k].point, rest[k + 1].point);
      for (const Corner& each : {rest[0], rest[k], rest[k + 1]}) result.colours.push_back(each.colour);
    }
  }
  return result;
}

LineList remains(const LineList& lines, const CutPlane& plane) {
  LineList result;
  for (std::size_t i = 0; i + 1 < lines.size(); i += 2) {
    const double ha = plane.height(lines[i]), hb = plane.height(lines[i + 1]);
    if (ha > 0 && hb > 0) continue;
    const Eigen::Vector3d crossing = lines[i] + (ha == hb ? 0 : ha / (ha - hb)) * (lines[i + 1] - lines[i]);
    result.push_back(ha > 0 ? crossing : lines[i]);
    result.push_back(hb > 0 ? crossing : lines[i + 1]);
  }
  return result;
}

std::vector<Eigen::Vector3d> outline(const std::vector<Eigen::Vector3d>& vertices,
                                     const std::vector<std::array<int, 3>>& triangles, const CutPlane& plane) {
  std::vector<double> heights;
  for (const Eigen::Vector3d& vertex : vertices) heights.push_back(plane.height(vertex));
  std::map<Edge, Edge> next = crossings(heights, triangles);
  std::vector<Eigen::Vector3d> longest;
  while (!next.empty()) {
    std::vector<Eigen::Vector3d> curve;
    for (auto at = next.begin(); at != next.end();) {
      const auto [a, b] = at->first;
      curve.emplace_back(vertices[a] + heights[a] / (heights[a] - heights[b]) * (vertices[b] - vertices[a]));
      const Edge following = at->second;
      next.erase(at);
      at = next.find(following);
    }
    if (length(curve) > length(longest)) longest = std::move(curve);
  }
  return longest;
}

TriangleSoup inside(const std::vector<Eigen::Vector3d>& curve, const CutPlane& plane, const Colour& colour) {
  if (curve.size() < 3) return {};
  const Eigen::Vector3d x = plane.normal.unitOrthogonal(), y = plane.normal.cross(x);
  std::vector<Eigen::Vector2d> flat;
  double area = 0;
  for (const Eigen::Vector3d& point : curve) flat.emplace_back(x.dot(point - curve[0]), y.dot(point - curve[0]));
  for (std::size_t i = 0; i < flat.size(); ++i) area += turn({0, 0}, flat[i], flat[(i + 1) % flat.size()]);
  std::vector<Eigen::Vector3d> ordered = curve;
  if (area < 0) {
    ordered.assign(curve.rbegin(), curve.rend());
    flat.assign(flat.rbegin(), flat.rend());
  }
  TriangleSoup soup;
  for (const auto& [a, b, c] : polygonTriangles(flat)) soup.add(ordered[a], ordered[b], ordered[c]);
  soup.colours.assign(soup.points.size(), colour);
  return soup;
}

LineList segments(const std::vector<Eigen::Vector3d>& curve) {
  LineList lines;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    lines.push_back(curve[i]);
    lines.push_back(curve[(i + 1) % curve.size()]);
  }
  return lines;
}

}  // namespace microinjection
