#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace microinjection {

/// Twice the signed area of a triangle: positive when a, b, c are counter-clockwise.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

/// n - 2 triangles of a simple polygon of n corners, counter-clockwise, by cutting off its ears (Meisters 1975; Eberly,
/// Triangulation by ear clipping, 2002). It takes time in proportion to n times the number of reflex corners.
///
/// Of a polygon that crosses itself, the triangles need not cover its inside.
std::vector<std::array<int, 3>> polygonTriangles(const std::vector<Eigen::Vector2d>& polygon);

}  // namespace microinjection
