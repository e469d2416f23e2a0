#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cell/material/material.h"
#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mechanics/load_path.h"
#include "cell/model/scene.h"

namespace microinjection {

template <int Dim>
class RigidContact;

/// A cell, glued below, with a hole from its upper pole into which a needle with a hemispherical end goes. Metres, Pa.
struct PiercedCellConfig {
  /// Tractions that hold the wall of the hole closed, see CohesiveWall.
  struct Cohesion {
    double toughness = 0;  ///< J/m^2
    double opening = 0;    ///< m
  };
  std::vector<Scene::Layer> layers = {Scene::Layer()};  ///< outermost first
  double held_radius = 5e-6;                            ///< m, nodes of the lower surface within it do not move
  double tip_radius = 3e-6;                             ///< m
  double hole_radius = 1e-6;                            ///< m, undeformed, below the tip's
  double hole_length = 10e-6;                           ///< m, undeformed, from the pole; 0: the whole cell
  double friction = 0;                                  ///< Coulomb's coefficient of needle and cell
  bool sticking = false;                                ///< what touches the needle sticks to it; of a whole cell
  double level = 0;                                     ///< of refinement: the elements are halved by each
  std::optional<Cohesion> cohesion;                     ///< of a hole that nothing has opened yet; its rim is rounded

  MaterialConfig& material() { return layers.front().material; }  ///< of the outermost layer
  const MaterialConfig& material() const { return layers.front().material; }
  double radius() const { return layers.front().outer_radius; }  ///< m, of the cell
};

/// Thrown where the tension of its surfaces tears an empty hole open.
class NotAtRest : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The solution of such a cell in its section while the needle is led along the axis: the branch of equilibria that a
/// puncture leads to (doc/design/puncture.md). Needle and hole touch by the contact of RigidContact. The tension of a
/// layer's sphere ends at the hole, and Laplace's pressure acts on the wall, too (SurfaceTension).
class PiercedCell {
 public:
  explicit PiercedCell(const PiercedCellConfig& config);
  ~PiercedCell();

  /// Leads the needle to a depth, m, below the undeformed pole. False: the stable equilibria end on the way, at
  /// depth(), see reason().
  bool advance(double depth);

  /// The same, also across instabilities of a pierced cell, each to the next equilibrium of less energy.
  bool advanceAcross(double depth) { return lead({0, 0, -depth}); }

  /// Puts a thin needle to the hole's bottom, lets it grow to its radius there, and leads it on until the force on it
  /// is `force`, N, or it can go no further. As it grows it is led deeper, so that it feels `pressing` times what a
  /// long hole pushes out with: one that feels less is pushed out of a hole of a material that stiffens. False: it does
  /// not stay at the bottom. @pre there is a hole, and no friction
  bool insert(double force, double pressing = 1.05);

  /// The hole's rim has the needle within it. @pre there is a hole
  bool isInside() const;

  double mouthOpening() const;  ///< m, of the wall below the rim, across the axis. @pre there is a hole

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
  bool follow(const Eigen::Vector3d& target);
  bool lead(const Eigen::Vector3d& target);
  bool jump(const Eigen::Vector3d& target);
  bool isAtBottom() const;
  Eigen::Vector3d place() const;
  const Material& materialAtBottom() const;

  PiercedCellConfig config_;
  LoadPathConfig path_config_;
  std::shared_ptr<LayeredBody<2>> body_;
  std::shared_ptr<RigidContact<2>> contact_;
  std::unique_ptr<EquilibriumSystem> system_;
  std::unique_ptr<LoadPath> path_;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< m, place at which path_ began
  int bottom_ = -1, rim_ = -1;                       ///< nodes
  std::string reason_;
};

}  // namespace microinjection
