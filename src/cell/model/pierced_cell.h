#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "cell/material/material.h"
#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mechanics/load_path.h"

namespace microinjection {

template <int Dim>
class RigidContact;

/// A homogeneous cell, glued below, with a hole from its upper pole into which a needle with a hemispherical end goes.
/// Metres, Pa.
struct PiercedCellConfig {
  MaterialConfig material;
  double radius = 28e-6;       ///< m, of the cell
  double held_radius = 5e-6;   ///< m, nodes of the lower surface within it do not move
  double tip_radius = 3e-6;    ///< m
  double hole_radius = 1e-6;   ///< m, undeformed, below the tip's
  double hole_length = 10e-6;  ///< m, undeformed, from the pole; 0: the whole cell
  double friction = 0;         ///< Coulomb's coefficient of needle and cell
  bool sticking = false;       ///< what touches the needle sticks to it; of a whole cell
  double level = 0;            ///< of refinement: the elements are halved by each
};

/// The solution of such a cell in its section while the needle is led along the axis: the branch of equilibria that a
/// puncture leads to (doc/design/puncture.md). Needle and hole touch without a gap, by the contact of RigidContact; the
/// needle opens the hole as it goes in, so the path starts above the cell as every indentation does.
class PiercedCell {
 public:
  explicit PiercedCell(const PiercedCellConfig& config);
  ~PiercedCell();

  /// Leads the needle to a depth, m, below the undeformed pole. False: no equilibrium was found, see reason().
  bool advance(double depth);

  /// Puts a needle that is thinner than the hole at a depth, m, and lets it grow to its radius there.
  bool insert(double depth);

  const std::string& reason() const { return reason_; }
  double force() const;        ///< N, that pushes the needle out
  double energy() const;       ///< J, of the cell
  double depth() const;        ///< m, reached
  double bottom() const;       ///< m, of the hole's lowest point below the undeformed pole; of the pole without a hole
  double penetration() const;  ///< m, largest, of needle and surface
  int unknowns() const;
  /// (r, z) of nodes and triangles (corners), deformed, m, for pictures.
  std::vector<Eigen::Vector2d> places() const;
  const QuadraticMesh<2>& mesh() const { return body_->mesh(); }

 private:
  Constraints constraints(const PiercedCellConfig& config) const;

  double thinner_ = 0;       ///< m, than the needle
  double touch_height_ = 0;  ///< m, of the tip at depth 0
  std::shared_ptr<LayeredBody<2>> body_;
  std::shared_ptr<RigidContact<2>> contact_;
  std::unique_ptr<EquilibriumSystem> system_;
  std::unique_ptr<LoadPath> path_;
  int bottom_ = -1;  ///< node
  std::string reason_;
};

}  // namespace microinjection
