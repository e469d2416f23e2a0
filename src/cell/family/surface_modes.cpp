#include "cell/family/surface_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>
#include <utility>

namespace microinjection {
namespace {

constexpr Eigen::Index kModes = 60;
constexpr double kNegligible = 1e-11;  ///< eigenvalue, relative to the largest

}  // namespace

void SurfaceModes::add(const Eigen::MatrixXf& displacements) {
  // Columns with the same span and the same moments as all surfaces: scaled modes, then the new ones.
  const Eigen::Index old = modes_.cols();
  Eigen::MatrixXd columns(displacements.rows(), old + displacements.cols());
  if (old > 0) {
    Eigen::MatrixXd second = Eigen::MatrixXd::Zero(old, old);
    for (const Eigen::MatrixXf& member : amplitudes_) {
      second += member.transpose().cast<double>() * member.cast<double>();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> moments(second);
    columns.leftCols(old) =
        modes_.cast<double>() * moments.eigenvectors() * moments.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  }
  columns.rightCols(displacements.cols()) = displacements.cast<double>();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(columns.transpose() * columns);
  const Eigen::Index significant =
      (eigen.eigenvalues().array() > kNegligible * eigen.eigenvalues().tail(1).value()).count();
  const Eigen::Index count = std::min(kModes, significant);
  const Eigen::MatrixXd basis = columns * eigen.eigenvectors().rightCols(count) *
                                eigen.eigenvalues().tail(count).cwiseSqrt().cwiseInverse().asDiagonal();
  for (Eigen::MatrixXf& member : amplitudes_) {
    member = (member.cast<double>() * (modes_.cast<double>().transpose() * basis)).cast<float>();
  }
  amplitudes_.emplace_back((displacements.cast<double>().transpose() * basis).cast<float>());
  modes_ = basis.cast<float>();
}

void SurfaceModes::set(Eigen::MatrixXf modes, std::vector<Eigen::MatrixXf> amplitudes) {
  for (const Eigen::MatrixXf& member : amplitudes) {
    if (member.cols() != modes.cols() || member.rows() != amplitudes.front().rows()) {
      throw std::invalid_argument("SurfaceModes: sizes do not fit");
    }
  }
  modes_ = std::move(modes);
  amplitudes_ = std::move(amplitudes);
}

}  // namespace microinjection
