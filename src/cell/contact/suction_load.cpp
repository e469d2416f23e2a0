#include "cell/contact/suction_load.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

/// Half the width over which the pressure falls to zero, over the lip's edge radius.
constexpr double kWidth = 0.1;

constexpr double kOnEquator = 1e-9;  ///< of a node's height over the cell's radius: rounding

/// Distance of the seal from the middle of the contact, over the contact's standard deviation, beyond which it moves.
constexpr double kOffMiddle = 0.5;

/// 1 inside of the seal, 0 outside, twice continuously differentiable.
struct Step {
  Step(double r, double seal, double width) {
    const double t = std::clamp(0.5 * (1 + (seal - r) / width), 0.0, 1.0), dt = -0.5 / width;
    value = t * t * t * (10 + t * (6 * t - 15));
    slope = 30 * t * t * (1 - t) * (1 - t) * dt;
    bend = 60 * t * (1 - t) * (1 - 2 * t) * dt * dt;
  }
  double value, slope, bend;  ///< 1, 1/m, 1/m^2
};

/// chi(r) (z - z0) n_z dA of a section. Facets of an arc go from -z to +z, hence n_z dA = -2 pi r dr.
void addTongue(const Eigen::Matrix2d& at, double plane, double seal, double width, SurfaceDensity<2>& density) {
  const double r = at(0, 0), height = at(1, 0) - plane, dr = at(0, 1);
  const Step chi(r, seal, width);
  const double q = -2 * M_PI * r * chi.value, q1 = -2 * M_PI * (chi.value + r * chi.slope),
               q2 = -2 * M_PI * (2 * chi.slope + r * chi.bend);
  density.value += q * height * dr;
  density.gradient += Eigen::Vector4d(q1 * height * dr, q * dr, q * height, 0);
  density.hessian(0, 0) += q2 * height * dr;
  density.hessian(0, 1) += q1 * dr;
  density.hessian(0, 2) += q1 * height;
  density.hessian(1, 2) += q;
  density.hessian.triangularView<Eigen::StrictlyLower>() = density.hessian.transpose();
}

/// In space n_z dA is the z component of the tangents' product.
void addTongue(const Eigen::Matrix3d& at, double plane, double seal, double width, SurfaceDensity<3>& density) {
  const Eigen::Vector3d x = at.col(0), a = at.col(1), b = at.col(2);
  const double r = x.head<2>().norm(), height = x.z() - plane, area = a.x() * b.y() - a.y() * b.x();
  const Step chi(r, seal, width);
  Eigen::Vector3d step = Eigen::Vector3d::Zero(), up = Eigen::Vector3d::UnitZ();  // gradients of chi and height
  Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
  if (r > 0) {
    const Eigen::Vector3d out(x.x() / r, x.y() / r, 0), around(-out.y(), out.x(), 0);
    step = chi.slope * out;
    bend = chi.bend * out * out.transpose() + chi.slope / r * around * around.transpose();
  }
  Eigen::Matrix<double, 6, 1> turn;  // gradient of the area
  turn << b.y(), -b.x(), 0, -a.y(), a.x(), 0;
  const Eigen::Vector3d slope = height * step + chi.value * up;
  density.value += chi.value * height * area;
  density.gradient.head<3>() += area * slope;
  density.gradient.tail<6>() += chi.value * height * turn;
  density.hessian.topLeftCorner<3, 3>() += area * (height * bend + step * up.transpose() + up * step.transpose());
  density.hessian.topRightCorner<3, 6>() += slope * turn.transpose();
  density.hessian.bottomLeftCorner<6, 3>() += turn * slope.transpose();
  const double both = chi.value * height;
  density.hessian(3, 7) += both;
  density.hessian(7, 3) += both;
  density.hessian(4, 6) -= both;
  density.hessian(6, 4) -= both;
}

}  // namespace

template <int Dim>
SuctionLoad<Dim>::SuctionLoad(const LayeredBody<Dim>& body, const PipetteMouth& mouth, double cell_radius, double plane,
                              std::shared_ptr<const RigidContact<Dim>> lip, int entry, double unit)
    : surface_(body),
      lip_(std::move(lip)),
      plane_(plane),
      side_(mouth.side()),
      width_(kWidth * mouth.edgeRadius()),
      first_seal_(mouth.touchRadius(cell_radius)),
      entry_(entry),
      unit_(unit) {
  for (const auto& facet : body.mesh().facets) {
    if (facet.layer != 0) continue;
    Facet result = surface_.facet(body, facet);
    // The half of the surface that faces the mouth; at its border chi is zero.
    if ((side_ * result.undeformed.row(Dim - 1)).minCoeff() < -kOnEquator * cell_radius) continue;
    result.entries.push_back(entry);
    facets_.push_back(std::move(result));
  }
  reset();
}

template <int Dim>
bool SuctionLoad<Dim>::integrate(const Facet& facet, const Eigen::VectorXd& state, Order order,
                                 LocalEnergy& result) const {
  const auto add = [&](const auto& at, SurfaceDensity<Dim>& density) {
    addTongue(at, plane_, seal_, width_, density);
    return true;
  };
  return surface_.integrate(surface_.positions(facet, state), order, add, result);
}

template <int Dim>
bool SuctionLoad<Dim>::evaluate(int index, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const {
  const Facet& facet = facets_[index];
  if (!integrate(facet, state, order, result)) return false;
  const double volume = result.energy, pressure = unit_ * state[entry_];
  result.energy = pressure * volume;
  if (order == Order::kEnergy) return true;
  const Eigen::Index nodes = result.gradient.size();
  const Eigen::VectorXd slope = result.gradient;
  result.gradient.resize(nodes + 1);
  result.gradient << pressure * slope, unit_ * volume;
  if (order != Order::kHessian) return true;
  const Eigen::MatrixXd bend = pressure * result.hessian;
  result.hessian.resize(nodes + 1, nodes + 1);
  result.hessian << bend, unit_ * slope, unit_ * slope.transpose(), 0.0;
  return true;
}

template <int Dim>
double SuctionLoad<Dim>::volume(const Eigen::VectorXd& state) const {
  double sum = 0;
  LocalEnergy local;
  for (const Facet& facet : facets_) sum += integrate(facet, state, Order::kEnergy, local) ? local.energy : NAN;
  return sum;
}

template <int Dim>
double SuctionLoad<Dim>::apex(const Eigen::VectorXd& state) const {
  double highest = -INFINITY;
  for (const Facet& facet : facets_) {
    const auto x = surface_.positions(facet, state);
    for (Eigen::Index a = 0; a < x.cols(); ++a) {
      if (x.col(a).head(Dim - 1).norm() < seal_) highest = std::max(highest, side_ * (x(Dim - 1, a) - plane_));
    }
  }
  return highest;
}

template <int Dim>
bool SuctionLoad<Dim>::beginStep(double /*duration*/) {
  seal_ = accepted_seal_;
  return false;
}

template <int Dim>
bool SuctionLoad<Dim>::settle(const Eigen::VectorXd& state) {
  const auto ring = lip_->ring(state);
  if (ring.radius == 0 || std::abs(ring.radius - seal_) <= kOffMiddle * std::max(ring.spread, width_)) return false;
  seal_ = ring.radius;
  return true;
}

template <int Dim>
void SuctionLoad<Dim>::accept(const Eigen::VectorXd& /*state*/) {
  accepted_seal_ = seal_;
}

template <int Dim>
void SuctionLoad<Dim>::reset() {
  seal_ = accepted_seal_ = first_seal_;
}

template class SuctionLoad<2>;
template class SuctionLoad<3>;

}  // namespace microinjection
