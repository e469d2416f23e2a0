#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/mesh/quadratic_mesh.h"

namespace microinjection {

/// Nodes on a cell's undeformed sphere at which surrogate cells store their surface. They lie in
/// rings about the contact point: narrow under the tip, wide on the far side. The grid is the same
/// for every cell and mesh, so that surfaces of different cells can be combined. Its half y < 0 is
/// the mirror image of the other.
class SurfaceGrid {
 public:
  /// The only one.
  static const SurfaceGrid& standard();

  int nodeCount() const { return static_cast<int>(directions_.cols()); }
  /// Counter-clockwise seen from outside.
  const std::vector<Eigen::Vector3i>& triangles() const { return triangles_; }
  /// The mirror image in y of each node.
  const std::vector<int>& mirrored() const { return mirrored_; }
  /// Nodes at rest (m, xyz each) of a sphere, for a contact point at `angle` (rad) from the pole, in
  /// the contact frame.
  Eigen::VectorXd nodes(double radius, double angle) const;

 private:
  SurfaceGrid();

  Eigen::Matrix3Xd directions_;  ///< of each node from the centre, for a contact point at the pole
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<int> mirrored_;
};

/// Interpolates the displacement of a mesh's outer surface at the nodes of the grid, linearly in
/// the triangles of outerTriangles(). Constructed once for a mesh.
class GridInterpolation {
 public:
  /// `half`: the mesh is the half y >= 0 of a cell that is symmetric. Throws std::invalid_argument
  /// when no triangle lies over a node.
  GridInterpolation(const QuadraticMesh<3>& mesh, double angle, bool half);

  /// m, xyz of each node of the grid, from a state that begins with xyz of each node of the mesh.
  Eigen::VectorXf displacement(const Eigen::VectorXd& state) const;

 private:
  struct Place {
    Eigen::Vector3i nodes;    ///< of the mesh
    Eigen::Vector3d weights;  ///< of them
    double side;              ///< -1 for a mirror image
  };
  std::vector<Place> places_;
};

}  // namespace microinjection
