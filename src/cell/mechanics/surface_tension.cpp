#include "cell/mechanics/surface_tension.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "cell/material/volume.h"

namespace microinjection {
namespace {

constexpr double kOnSphere = 1e-6;  ///< of the radius

/// Area |a1 x a2| = sqrt(g) with the metric's determinant g. False when it vanishes.
bool addArea(const Eigen::Matrix3d& at, double tension, SurfaceDensity<3>& density) {
  const Eigen::Vector3d a1 = at.col(1), a2 = at.col(2);
  const double g11 = a1.squaredNorm(), g22 = a2.squaredNorm(), g12 = a1.dot(a2);
  const double area = a1.cross(a2).norm();
  if (!(area > 0)) return false;
  Eigen::Matrix<double, 6, 1> dg;
  dg << 2 * (g22 * a1 - g12 * a2), 2 * (g11 * a2 - g12 * a1);
  Eigen::Matrix<double, 6, 6> ddg;
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d mixed = 4 * a1 * a2.transpose() - 2 * a2 * a1.transpose() - 2 * g12 * one;
  ddg << 2 * (g22 * one - a2 * a2.transpose()), mixed, mixed.transpose(), 2 * (g11 * one - a1 * a1.transpose());
  density.value += tension * area;
  density.gradient.tail<6>() += tension / (2 * area) * dg;
  density.hessian.bottomRightCorner<6, 6>() +=
      tension / (2 * area) * (ddg - 1 / (2 * area * area) * dg * dg.transpose());
  return true;
}

/// Volume 1/3 x . (a1 x a2) of the cone from the origin.
void addVolume(const Eigen::Matrix3d& at, double pressure, SurfaceDensity<3>& density) {
  const Eigen::Vector3d x = at.col(0), a1 = at.col(1), a2 = at.col(2);
  const double factor = -pressure / 3;
  density.value += factor * x.dot(a1.cross(a2));
  Eigen::Matrix<double, 9, 1> gradient;
  gradient << a1.cross(a2), a2.cross(x), x.cross(a1);
  density.gradient += factor * gradient;
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero(), xx = cross(x), aa1 = cross(a1), aa2 = cross(a2);
  Eigen::Matrix<double, 9, 9> hessian;
  hessian << none, -aa2, aa1, aa2, none, -xx, -aa1, xx, none;
  density.hessian += factor * hessian;
}

/// Area 2 pi r |t|, t the tangent. False when it vanishes or the axis is crossed.
bool addArea(const Eigen::Matrix2d& at, double tension, SurfaceDensity<2>& density) {
  const double r = at(0, 0), length = at.col(1).norm(), factor = 2 * M_PI * tension;
  if (!(r > 0) || !(length > 0)) return false;
  const Eigen::Vector2d direction = at.col(1) / length;
  density.value += factor * r * length;
  density.gradient[0] += factor * length;
  density.gradient.tail<2>() += factor * r * direction;
  density.hessian.block<2, 1>(2, 0) += factor * direction;
  density.hessian.block<1, 2>(0, 2) += factor * direction.transpose();
  density.hessian.bottomRightCorner<2, 2>() +=
      factor * r / length * (Eigen::Matrix2d::Identity() - direction * direction.transpose());
  return true;
}

/// Volume pi r^2 dz of a slice.
void addVolume(const Eigen::Matrix2d& at, double pressure, SurfaceDensity<2>& density) {
  const double r = at(0, 0), dz = at(1, 1), factor = -pressure * M_PI;
  density.value += factor * r * r * dz;
  density.gradient[0] += factor * 2 * r * dz;
  density.gradient[3] += factor * r * r;
  density.hessian(0, 0) += factor * 2 * dz;
  density.hessian(0, 3) += factor * 2 * r;
  density.hessian(3, 0) += factor * 2 * r;
}

}  // namespace

template <int Dim>
SurfaceTension<Dim>::SurfaceTension(const LayeredBody<Dim>& body, int layer, double radius, double tension)
    : tension_(tension), pressure_(2 * tension / radius), surface_(body) {
  if (!(radius > 0)) throw std::invalid_argument("radius " + std::to_string(radius) + " must be positive");
  if (!(tension >= 0)) throw std::invalid_argument("tension " + std::to_string(tension) + " must not be negative");
  const auto onSurface = [&](const auto& facet) {
    return facet.layer == layer && (Dim == 3 || std::all_of(facet.nodes.begin(), facet.nodes.end(), [&](int node) {
                                      return std::abs(body.mesh().nodes[node].norm() / radius - 1) < kOnSphere;
                                    }));
  };
  bool pierced = false;
  for (const auto& facet : body.mesh().facets) {
    const bool tense = onSurface(facet), wall = !tense && Dim == 2 && facet.outer && facet.layer >= layer;
    if (!tense && !wall) continue;
    pierced = pierced || wall;
    Facet result{surface_.facet(body, facet), tense, 0, {}};
    LocalEnergy undeformed;
    if (!integrate(result.undeformed, tense ? tension_ : 0, pressure_, Order::kGradient, undeformed)) {
      throw std::invalid_argument("facet " + std::to_string(facets_.size()) + " of layer " + std::to_string(layer) +
                                  " has no area");
    }
    result.energy = undeformed.energy;
    result.dead_load = undeformed.gradient;
    facets_.push_back(std::move(result));
  }
  if (pierced) {
    double area = 0;
    LocalEnergy local;
    for (Facet& facet : facets_) {
      facet.dead_load.setZero();
      if (facet.tense && integrate(facet.undeformed, 1, 0, Order::kEnergy, local)) area += local.energy;
    }
    facets_.front().energy += tension_ * (4 * M_PI * radius * radius - area);
  }
  if (facets_.empty()) throw std::invalid_argument("the body has no surface of layer " + std::to_string(layer));
}

template <int Dim>
bool SurfaceTension<Dim>::integrate(const Positions& x, double tension, double pressure, Order order,
                                    LocalEnergy& result) const {
  const auto add = [&](const auto& at, SurfaceDensity<Dim>& density) {
    if (!addArea(at, tension, density)) return false;
    addVolume(at, pressure, density);
    return true;
  };
  return surface_.integrate(x, order, add, result);
}

template <int Dim>
bool SurfaceTension<Dim>::evaluate(int index, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const {
  const Facet& facet = facets_[index];
  const Positions x = surface_.positions(facet, state);
  if (!integrate(x, facet.tense ? tension_ : 0, pressure_, order, result)) return false;
  const Positions u = x - facet.undeformed;
  result.energy -= facet.energy + facet.dead_load.dot(Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()));
  if (order != Order::kEnergy) result.gradient -= facet.dead_load;
  return true;
}

template <int Dim>
double SurfaceTension<Dim>::total(const Eigen::VectorXd& state, double tension, double pressure) const {
  double sum = 0;
  LocalEnergy local;
  for (const Facet& facet : facets_) {
    const bool defined =
        integrate(surface_.positions(facet, state), facet.tense ? tension : 0, pressure, Order::kEnergy, local);
    sum += defined ? local.energy : std::numeric_limits<double>::quiet_NaN();
  }
  return sum;
}

template <int Dim>
double SurfaceTension<Dim>::area(const Eigen::VectorXd& state) const {
  return total(state, 1, 0);
}

template <int Dim>
double SurfaceTension<Dim>::enclosedVolume(const Eigen::VectorXd& state) const {
  return total(state, 0, -1);
}

template class SurfaceTension<2>;
template class SurfaceTension<3>;

}  // namespace microinjection
