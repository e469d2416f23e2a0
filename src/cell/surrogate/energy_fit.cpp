#include "cell/surrogate/energy_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>

namespace microinjection {

double largestForce(const std::vector<TrainingSample>& samples) {
  double result = 0;
  for (const TrainingSample& sample : samples) result = std::max(result, sample.force.norm());
  return result;
}

void fitEnergy(EnergyExpansion& expansion, const std::vector<TrainingSample>& samples) {
  const int unknowns = expansion.size(), rows = 3 * static_cast<int>(samples.size());
  const double largest = largestForce(samples);
  if (!(largest > 0)) throw std::invalid_argument("no training sample has a force");
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows), energy;
  Eigen::Matrix3Xd gradient;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].force.isZero(0)) continue;  // the tip has lost the cell
    const double weight = 1 / (samples[i].force.norm() + kFitFloor * largest);
    expansion.basis(samples[i].angle, samples[i].displacement, energy, gradient);
    matrix.middleRows<3>(3 * i) = weight * gradient;
    right.segment<3>(3 * i) = -weight * samples[i].force;
  }
  expansion.setCoefficients(solveRegularised(matrix, right));
}

Eigen::VectorXd solveRegularised(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  constexpr double kRegularisation = 1e-4;
  const Eigen::Index rows = matrix.rows(), unknowns = matrix.cols();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows + unknowns, unknowns);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(rows + unknowns);
  all.topRows(rows) = matrix;
  all.bottomRows(unknowns).diagonal() = kRegularisation * matrix.colwise().norm();
  values.head(rows) = right;
  return all.colPivHouseholderQr().solve(values);
}

}  // namespace microinjection
