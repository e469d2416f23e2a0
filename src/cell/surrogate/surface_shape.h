#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/bytes.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// Places of a contact in units of the range: contact angle, displacement of the tip.
Eigen::Vector4d contactVariables(const SurrogateRange& range, double angle, const Eigen::Vector3d& displacement);

/// Shape of the cell's surface as a function of contact point and displacement of the tip. It has
/// few modes (proper orthogonal decomposition), whose amplitudes are interpolated by radial basis
/// functions of contactVariables. Displacements with y < 0 use the mirror image in the plane of axis
/// and needle. Nodes and triangles are those of SurfaceGrid.
class SurfaceShape {
 public:
  SurfaceShape() = default;
  /// Fits training samples, and the cell at rest for the `angles` (rad). `radius` (m): of the cell.
  SurfaceShape(const SurrogateRange& range, double radius, const std::vector<double>& angles,
               const std::vector<TrainingSample>& samples);
  /// @param centres contactVariables, a column each
  /// @param amplitudes of the modes (columns) at each centre (rows)
  /// @param modes m, a column each
  SurfaceShape(const SurrogateRange& range, double radius, const Eigen::MatrixXd& centres,
               const Eigen::MatrixXd& amplitudes, const Eigen::MatrixXf& modes);

  /// Changes to a unit of length, given in the new one.
  void changeUnit(double length);

  /// Positions of all nodes at rest and their displacement, m, xyz each, in the contact frame.
  void evaluate(double angle, const Eigen::Vector3d& displacement, Eigen::VectorXd& at_rest,
                Eigen::VectorXd& displaced) const;

  void write(ByteWriter& writer) const;
  /// Throws std::runtime_error when sizes or values are invalid.
  static SurfaceShape read(ByteReader& reader);

 private:
  bool consistent() const;  ///< sizes
  bool finite() const;      ///< values

  SurrogateRange range_;
  double radius_ = 0;
  Eigen::MatrixXd centres_;  ///< a column each
  Eigen::MatrixXd weights_;  ///< of radialBasis (rows), for each mode (columns)
  Eigen::MatrixXf modes_;    ///< m, a column each
};

}  // namespace microinjection
