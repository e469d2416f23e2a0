#include "cell/surrogate/force_field.h"

#include <stdexcept>

namespace microinjection {
namespace {

constexpr EnergyDegrees kAway = {3, 4, 7, 1}, kLateral = {4, 3, 7, 1}, kAxial = {4, 4, 7, 1};

EnergyScales forceScales(EnergyScales scales) {
  scales.energy /= scales.length;
  return scales;
}

}  // namespace

ForceField::ForceField(const EnergyScales& scales)
    : scales_(scales),
      away_(forceScales(scales), kAway),
      lateral_(forceScales(scales), kLateral),
      axial_(forceScales(scales), kAxial) {}

void ForceField::changeUnits(double length, double energy) {
  scales_.length *= length;
  scales_.energy *= energy;
  for (EnergyExpansion* expansion : {&away_, &lateral_, &axial_}) expansion->changeUnits(length, energy / length);
}

void ForceField::fit(const std::vector<TrainingSample>& samples) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  const int a_size = away_.size(), b_size = lateral_.size();
  Eigen::MatrixXd sideways = Eigen::MatrixXd::Zero(2 * count, a_size + b_size);
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(count, axial_.size());
  Eigen::VectorXd sideways_right = Eigen::VectorXd::Zero(2 * count), along_right = Eigen::VectorXd::Zero(count), values;
  Eigen::Matrix3Xd gradients;
  const double largest = largestForce(samples);
  for (Eigen::Index i = 0; i < count; ++i) {
    const TrainingSample& sample = samples[i];
    if (sample.force.isZero(0)) continue;  // the tip has lost the cell
    const double weight = 1 / (sample.force.norm() + kFitFloor * largest), c = sample.angle / scales_.angle;
    const Eigen::Vector3d direction = sample.displacement.normalized();
    away_.basis(sample.angle, sample.displacement, values, gradients);
    sideways.row(2 * i).head(a_size) = weight * c * values;
    lateral_.basis(sample.angle, sample.displacement, values, gradients);
    sideways.row(2 * i).tail(b_size) = weight * direction.x() * values;
    sideways.row(2 * i + 1).tail(b_size) = weight * direction.y() * values;
    sideways_right.segment<2>(2 * i) = weight * sample.force.head<2>();
    axial_.basis(sample.angle, sample.displacement, values, gradients);
    along.row(i) = weight * values;
    along_right[i] = weight * sample.force.z();
  }
  const Eigen::VectorXd lateral = solveRegularised(sideways, sideways_right);
  away_.setCoefficients(lateral.head(a_size));
  lateral_.setCoefficients(lateral.tail(b_size));
  axial_.setCoefficients(solveRegularised(along, along_right));
}

void ForceField::scaleAlongPaths(const std::function<double(double)>& factor,
                                 const std::function<double(double)>& size) {
  for (EnergyExpansion* expansion : {&away_, &lateral_, &axial_}) expansion->scaleAlongPaths(factor, size);
}

void ForceField::makeLocal(double angle, Local& local) const {
  local.scaled_angle_ = angle / scales_.angle;
  away_.makeLocal(angle, local.away_);
  lateral_.makeLocal(angle, local.lateral_);
  axial_.makeLocal(angle, local.axial_);
}

Eigen::Vector3d ForceField::Local::evaluate(const Eigen::Vector3d& u, Eigen::Matrix3d& jacobian) const {
  jacobian.setZero();
  Jet squared;
  for (int k = 0; k < 3; ++k) {
    const Jet x = Jet::coordinate(k, u[k]);
    squared = squared + x * x;
  }
  if (!(squared.value > 0)) return Eigen::Vector3d::Zero();
  const Jet scale = inverse(sqrt(squared)), across = lateral_.evaluate(u);
  const Jet x = scaled_angle_ * away_.evaluate(u) + Jet::coordinate(0, u.x()) * scale * across;
  const Jet y = Jet::coordinate(1, u.y()) * scale * across, z = axial_.evaluate(u);
  jacobian << x.gradient.transpose(), y.gradient.transpose(), z.gradient.transpose();
  return {x.value, y.value, z.value};
}

Eigen::VectorXd ForceField::coefficients() const {
  Eigen::VectorXd all(away_.size() + lateral_.size() + axial_.size());
  all << away_.coefficients(), lateral_.coefficients(), axial_.coefficients();
  return all;
}

void ForceField::setCoefficients(const Eigen::VectorXd& coefficients) {
  if (coefficients.size() != away_.size() + lateral_.size() + axial_.size()) {
    throw std::invalid_argument("ForceField: wrong number of coefficients");
  }
  away_.setCoefficients(coefficients.head(away_.size()));
  lateral_.setCoefficients(coefficients.segment(away_.size(), lateral_.size()));
  axial_.setCoefficients(coefficients.tail(axial_.size()));
}

}  // namespace microinjection
