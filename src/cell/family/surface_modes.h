#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

/// Surfaces of all members in common modes (proper orthogonal decomposition). A member is a matrix
/// of amplitudes, a row for each place and a column for each mode. Members are added one by one: the
/// modes then change to the best ones for all (incremental singular value decomposition, Brand,
/// Linear Algebra Appl. 415 (2006) 20).
class SurfaceModes {
 public:
  /// Displacements of a new member: entries (rows) at each place (columns).
  void add(const Eigen::MatrixXf& displacements);

  const Eigen::MatrixXf& modes() const { return modes_; }  ///< entries x modes
  const std::vector<Eigen::MatrixXf>& amplitudes() const { return amplitudes_; }

  /// Throws std::invalid_argument when the sizes do not fit.
  void set(Eigen::MatrixXf modes, std::vector<Eigen::MatrixXf> amplitudes);

 private:
  Eigen::MatrixXf modes_;
  std::vector<Eigen::MatrixXf> amplitudes_;
};

}  // namespace microinjection
