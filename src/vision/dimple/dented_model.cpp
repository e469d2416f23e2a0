#include "vision/dimple/dented_model.h"

#include <Eigen/Dense>

namespace microinjection::dented {

Vector startOf(const Ellipse& start, const Local& local) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(start.angle).toRotationMatrix();
  const Eigen::Matrix2d root = turn * start.semi_axes.cwiseInverse().asDiagonal() * turn.transpose() * local.unit;
  Vector p;
  p << 0, 0, local.v.dot(root * local.v), local.u.dot(root * local.u), local.v.dot(root * local.u), 0, 0, 0;
  return p;
}

Ellipse ellipseOf(const Vector& p, const Local& local) {
  Eigen::Matrix2d axes, root;
  axes << local.v, local.u;
  root << p[2], p[4], p[4], p[3];
  const Eigen::Matrix2d image = axes * root * axes.transpose() / local.unit;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(image);
  const Eigen::Vector2d major = solver.eigenvectors().col(0), centre = local.origin + local.unit * axes * p.head<2>();
  return {{centre.x(), centre.y()}, solver.eigenvalues().cwiseInverse(), std::atan2(major.y(), major.x())};
}

double heightAt(const Vector& p, double across) {
  Eigen::Matrix2d root;
  root << p[2], p[4], p[4], p[3];
  const Eigen::Vector2d from = root * Eigen::Vector2d(across - p[0], -p[1]), along = root.col(1);
  const double a = along.squaredNorm(), b = along.dot(from), c = from.squaredNorm() - 1, square = b * b - a * c;
  return square > 0 ? (std::sqrt(square) - b) / a : 0;
}

}  // namespace microinjection::dented
