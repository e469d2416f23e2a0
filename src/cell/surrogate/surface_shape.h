#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/bytes.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// Shape of the cell's surface as a function of contact point and displacement of the tip. It has
/// few modes (proper orthogonal decomposition of the training samples), whose amplitudes are
/// interpolated by radial basis functions (r^3, with a linear part). Displacements with y < 0 use
/// the mirror image in the plane of axis and needle.
class SurfaceShape {
 public:
  SurfaceShape() = default;
  /// @param surfaces undeformed, for the angles (rad, ascending) in `angles`
  SurfaceShape(const PreparationRange& range, const std::vector<double>& angles,
               const std::vector<TrainingSurface>& surfaces, const std::vector<TrainingSample>& samples);

  /// Changes to a unit of length, given in the new one.
  void changeUnit(double length);

  int nodeCount() const { return static_cast<int>(node_count_); }
  const std::vector<Eigen::Vector3i>& triangles() const { return triangles_; }

  /// Positions of all nodes at rest and their displacement, m, xyz each, in the contact frame.
  void evaluate(double angle, const Eigen::Vector3d& displacement, Eigen::VectorXd& at_rest,
                Eigen::VectorXd& displaced) const;

  void write(ByteWriter& writer) const;
  /// Throws std::runtime_error when sizes, indices or values are invalid.
  static SurfaceShape read(ByteReader& reader);

 private:
  Eigen::Vector4d variables(double angle, const Eigen::Vector3d& displacement) const;
  Eigen::VectorXd amplitudes(const Eigen::Vector4d& at) const;
  bool consistent() const;  ///< sizes and indices
  bool finite() const;      ///< values

  PreparationRange range_;
  std::int64_t node_count_ = 0;  ///< number of nodes
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<int> mirrored_;  ///< mirror image of each node
  Eigen::VectorXd angles_;     ///< rad
  Eigen::MatrixXd rest_;       ///< m, nodes at rest, a column for each of angles_
  Eigen::MatrixXd centres_;    ///< variables() of the samples, a column each
  Eigen::MatrixXd weights_;    ///< of each centre, then of 1 and the variables (rows), for each mode (columns)
  Eigen::MatrixXf modes_;      ///< m, a column each
};

}  // namespace microinjection
