#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/family/axis_force.h"
#include "cell/family/family.h"
#include "cell/family/path_forces.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// The part of its planned range that a member reached.
struct Reached {
  double share = 1;       ///< of the depth, by all paths
  double axis_share = 1;  ///< of the depth on the axis
};

/// A member of a family that was solved, without dimension. The coefficients are those of
/// SurrogateData with the scales of the member's plan, divided by `scale`.
struct FamilyMember {
  Eigen::VectorXd coordinates;
  Reached reached;                ///< of the planned range
  double scale = 1;               ///< see axisForce()
  Eigen::VectorXd energy, field;  ///< coefficients
  double median_error = 0;        ///< relative, of the member's own fit
  double common_error = 0;        ///< same, exceeded by one of ten samples
  std::vector<PathForces> paths;  ///< of planMember; empty where they are not known any more
};

/// The part that a member at other coordinates reaches: the mean of those that were solved, weighted
/// by their distance to the power of -4 (Shepard's interpolation).
Reached reachedAt(const Eigen::VectorXd& coordinates, const std::vector<const FamilyMember*>& solved);

/// What a member's forces are multiplied with to have another one's force on the axis. `field`: the
/// member's coefficients, with the other one's scales.
AxisCurve curveRatio(const AxisCurve& other, const FamilyMember& member, const ForceField& field,
                     const EnergyScales& scales);

/// Plan of a member's paths.
SurrogatePlan planMember(const Family& family, const Scene& member);

/// Fits a member to the results of planMember's paths. `displacements`: of SurfaceGrid (rows) at
/// surfacePlaces (columns), over the cell's radius. Throws as SurrogateData::fit.
FamilyMember fitMember(const Family& family, const Eigen::VectorXd& coordinates,
                       const std::vector<TrainingResult>& results, Eigen::MatrixXf& displacements);

/// Fits a member anew to the forces of its paths. @pre they are known
FamilyMember refitMember(const Family& family, const FamilyMember& member);

}  // namespace microinjection
