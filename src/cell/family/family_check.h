#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/family/family_data.h"

namespace microinjection {

/// Coordinates of members at random, for a check of the interpolation between the solved ones.
std::vector<Eigen::VectorXd> drawMembers(const Family& family, int count, int seed);

/// Converged paths to random places in a member's planned range, up to 56 degrees, 0.3 diameters deep and
/// 0.08 diameters sideways; two places on each. For odd seeds, one of five is out of the plane of
/// symmetry, where a path costs ten times as much. Each path is there on the fine mesh and, with its
/// surface, on the coarse one. Places near the first contact have a path on a finer mesh.
SurrogatePlan drawMotions(const Family& family, const Eigen::VectorXd& coordinates, int seed);

/// A place where a family's cell is compared with the converged solution.
struct CheckedPlace {
  int member = 0;            ///< number of the draw
  double angle = 0;          ///< rad
  double depth = 0;          ///< over the diameter
  double lateral = 0;        ///< over the diameter
  double force_share = 0;    ///< of the member's largest force
  double force_error = 0;    ///< relative
  double surface_error = 0;  ///< rms over the nodes of SurfaceGrid, over the diameter
};

/// A converged place of a member that was not solved for the family, without dimension.
struct ReferencePlace {
  int member = 0;                                          ///< number of the draw
  Eigen::VectorXd coordinates;                             ///< of the member
  double angle = 0;                                        ///< rad, of the contact point
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< of the tip, in the contact frame
  /// On the fine mesh, extrapolated to the limit (Richardson) with the smooth part of the change
  /// between the meshes; a single change scatters with the points in contact.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::VectorXf surface;  ///< displacements (xyz) of some nodes of SurfaceGrid: referenceNodes()
};

/// Indices of the nodes at which references have their surface.
std::vector<int> referenceNodes();

/// The places of a drawn member that were solved, from the results of drawMotions.
std::vector<ReferencePlace> referencePlaces(int member, const Eigen::VectorXd& coordinates,
                                            const SurrogatePlan& motions, const std::vector<TrainingResult>& results);

/// Compares the family's cells with converged places, as far as they are within its range.
/// `places`: a member's are in sequence.
std::vector<CheckedPlace> comparePlaces(const FamilyData& data, const std::vector<ReferencePlace>& places);

}  // namespace microinjection
