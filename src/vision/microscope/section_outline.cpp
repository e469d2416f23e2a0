#include "vision/microscope/section_outline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "base/errors.h"

namespace microinjection {
namespace {

/// Twice the area, positive when the outline turns from x towards z.
double doubleArea(const CellOutline& outline) {
  double area = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area;
}

using Side = std::pair<int, int>;  // of triangles, by its nodes in ascending order

/// The sides of triangles that the plane crosses, each with the sides that follow it on the section.
class Section {
 public:
  Section(const std::vector<Eigen::Vector3d>& nodes, double y) : nodes_(nodes), y_(y) {}

  void add(const std::array<int, 3>& triangle) {
    std::vector<Side> crossed;
    for (int i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      // A node on the plane counts as above it, so that a triangle has two crossed sides or none.
      if (above(a) != above(b)) crossed.emplace_back(std::min(a, b), std::max(a, b));
    }
    if (crossed.size() != 2) return;
    next_[crossed[0]].push_back(crossed[1]);
    next_[crossed[1]].push_back(crossed[0]);
  }

  /// Takes one curve; empty when none is left or the curve is open.
  bool takeCurve(CellOutline& curve) {
    curve.clear();
    if (next_.empty()) return false;
    const Side first = next_.begin()->first;
    Side side = first;
    bool closed = true;
    while (true) {
      curve.push_back(place(side));
      const std::vector<Side> following = next_[side];
      next_.erase(side);
      closed = closed && following.size() == 2;
      const auto onward =
          std::find_if(following.begin(), following.end(), [&](const Side& s) { return next_.count(s); });
      if (onward == following.end()) break;
      side = *onward;
    }
    if (!closed) curve.clear();
    return true;
  }

 private:
  bool above(int node) const { return nodes_[node].y() >= y_; }
  Eigen::Vector2d place(const Side& side) const {
    const Eigen::Vector3d& a = nodes_[side.first];
    const Eigen::Vector3d& b = nodes_[side.second];
    const Eigen::Vector3d point = a + (y_ - a.y()) / (b.y() - a.y()) * (b - a);
    return {point.x(), point.z()};
  }

  const std::vector<Eigen::Vector3d>& nodes_;
  double y_;
  std::map<Side, std::vector<Side>> next_;
};

}  // namespace

CellOutline sectionOutline(const std::vector<Eigen::Vector3d>& nodes, const std::vector<std::array<int, 3>>& triangles,
                           double y) {
  Section section(nodes, y);
  for (const std::array<int, 3>& triangle : triangles) {
    for (const int node : triangle) {
      if (node < 0 || node >= static_cast<int>(nodes.size()))
        throw ConfigError("surface: a triangle has the node " + std::to_string(node) + ", and there are " +
                          std::to_string(nodes.size()));
    }
    section.add(triangle);
  }
  CellOutline largest, curve;
  while (section.takeCurve(curve))
    if (curve.size() >= 3 && std::abs(doubleArea(curve)) > std::abs(doubleArea(largest))) largest = curve;
  return largest;
}

CellOutline insetOutline(const CellOutline& outline, double distance) {
  const std::size_t count = outline.size();
  const double sense = doubleArea(outline) > 0 ? 1 : -1;
  CellOutline inset;
  inset.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d before = (outline[i] - outline[(i + count - 1) % count]).normalized();
    const Eigen::Vector2d after = (outline[(i + 1) % count] - outline[i]).normalized();
    const Eigen::Vector2d along = before + after;
    const Eigen::Vector2d inward = sense * Eigen::Vector2d(-along.y(), along.x()).normalized();
    // Both sides move by the distance, and their corner by more.
    const double half_turn = std::max(0.5, along.norm() / 2);
    inset.emplace_back(outline[i] + distance / half_turn * inward);
  }
  return inset;
}

}  // namespace microinjection
