#include "vision/microscope/tongue_outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

constexpr int kTongueCorners = 96;
constexpr double kBellWidth = 0.4;  // rms, of the mouth's radius and the depth

/// The tongue from one side to the other, (along the axis, across): above a base at `base` along the axis.
std::vector<Eigen::Vector2d> tongueCorners(double base, const DrawingMouth& mouth) {
  const double height = mouth.length - base, cap = std::min(height, mouth.radius);
  const double sphere = (mouth.radius * mouth.radius + cap * cap) / (2 * cap);
  const double widest = cap < mouth.radius ? std::asin(mouth.radius / sphere) : M_PI / 2;
  std::vector<Eigen::Vector2d> corners{{base, -mouth.radius}};
  for (int i = 0; i <= kTongueCorners; ++i) {
    const double angle = widest * (2.0 * i / kTongueCorners - 1);
    corners.emplace_back(mouth.length - sphere * (1 - std::cos(angle)), sphere * std::sin(angle));
  }
  corners.emplace_back(base, mouth.radius);
  return corners;
}

/// m along the axis, from the mouth to the end of an outline without a tongue; negative: it ends before the mouth.
double reachInto(const CellOutline& outline, const DrawingMouth& mouth) {
  double reach = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& corner : outline) reach = std::max(reach, (corner - mouth.place).dot(mouth.axis));
  return reach;
}

/// A border `inset` (m) inside of the one that has a tongue, which rises by `rise` (m).
CellOutline besideTongue(const CellOutline& outline, const DrawingMouth& mouth, double inset, double rise) {
  const Eigen::Vector2d across(-mouth.axis.y(), mouth.axis.x());
  const double width = kBellWidth * std::hypot(mouth.radius, inset);
  const double height = std::max(0.0, rise) * std::exp(-inset / mouth.radius);
  Eigen::Vector2d middle(0, 0);
  for (const Eigen::Vector2d& corner : outline) middle += corner / static_cast<double>(outline.size());
  CellOutline moved = outline;
  for (Eigen::Vector2d& corner : moved) {
    if ((corner - middle).dot(mouth.axis) <= 0) continue;
    const double side = (corner - mouth.place).dot(across) / width;
    corner += height * std::exp(-side * side / 2) * mouth.axis;
  }
  return moved;
}

}  // namespace

CellOutline withTongue(const CellOutline& outline, const DrawingMouth& mouth) {
  if (outline.size() < 3 || reachInto(outline, mouth) >= mouth.length) return outline;
  const Eigen::Vector2d across(-mouth.axis.y(), mouth.axis.x());
  const std::size_t count = outline.size();
  std::vector<Eigen::Vector2d> seen(count);  // (along, across)
  double middle = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d away = outline[i] - mouth.place;
    seen[i] = {away.dot(mouth.axis), away.dot(across)};
    middle += seen[i].x() / static_cast<double>(count);
  }
  const auto before = [&](std::size_t i) {
    return std::abs(seen[i % count].y()) < mouth.radius && seen[i % count].x() > middle;
  };
  std::size_t first = 0;  // corner before the mouth, whose last one is not
  while (first < count && (!before(first) || before(first + count - 1))) ++first;
  if (first == count) return outline;
  std::size_t last = first;
  while (before(last + 1)) ++last;
  const auto edge = [&](std::size_t out, std::size_t in) {
    const Eigen::Vector2d &a = seen[out % count], &b = seen[in % count];
    const double side = std::copysign(mouth.radius, a.y());
    return a.x() + (side - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  };
  const double sides = seen[(first + count - 1) % count].y() * seen[(last + 1) % count].y();
  const double base = 0.5 * (edge(first + count - 1, first) + edge(last + 1, last));
  if (sides >= 0) return outline;
  std::vector<Eigen::Vector2d> tongue = tongueCorners(base, mouth);
  if (seen[(first + count - 1) % count].y() > 0) std::reverse(tongue.begin(), tongue.end());
  CellOutline drawn;
  for (const Eigen::Vector2d& corner : tongue)
    drawn.emplace_back(mouth.place + corner.x() * mouth.axis + corner.y() * across);
  for (std::size_t i = last + 1; i % count != first; ++i) drawn.push_back(outline[i % count]);
  return drawn;
}

void drawIn(const DrawingMouth& mouth, double zona, double gap, CellScene& cell) {
  if (!(zona > 0)) {
    cell.ooplasm = withTongue(cell.ooplasm, mouth);
    return;
  }
  const double rise = mouth.length - reachInto(cell.zona_outer, mouth);
  cell.zona_outer = withTongue(cell.zona_outer, mouth);
  cell.zona_inner = besideTongue(cell.zona_inner, mouth, zona, rise);
  cell.ooplasm = besideTongue(cell.ooplasm, mouth, zona + gap, rise);
}

}  // namespace microinjection
