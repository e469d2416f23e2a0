#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mesh/surface_mesh.h"
#include "cell/tensegrity/cables.h"
#include "cell/tensegrity/membrane.h"
#include "cell/tensegrity/tensegrity_config.h"
#include "cell/tensegrity/tensegrity_geometry.h"

namespace microinjection {

/// The paper's cytoskeleton as finite elements, at rest under its own prestress: struts of
/// tetrahedra, cables, membrane.
///
/// Nodes of a state: those of the struts' mesh, then the membrane's that are not strut ends; 3 n +
/// k is component k of node n's displacement from nodePositions(), in which struts are without
/// load. The state's last three entries are the tip's. Immutable after construction, safe to share
/// between threads.
class TensegrityStructure {
 public:
  /// Accuracy of the equilibrium at rest.
  struct Form {
    double residual = 0;   ///< N, largest unbalanced force, of any component of a free node
    double prestress = 0;  ///< N, largest tension of a cable
    int iterations = 0;    ///< of Newton's method, including the relaxation's factorisations
    double energy = 0;     ///< J
  };

  /// Finds the form. It starts from the equilibrium of TensegrityGeometry, releases all but the
  /// three held ends and solves. If that fails (struts near their Euler load), it applies the
  /// prestress step by step. The final residual is less than 1e-9 of the prestress, or at rounding
  /// of the struts' stress if that is larger. Throws ConfigError when the configuration is not
  /// valid, std::runtime_error when no stable equilibrium is found.
  explicit TensegrityStructure(const TensegrityConfig& config);

  const TensegrityConfig& config() const { return config_; }
  const TensegrityGeometry& geometry() const { return geometry_; }
  const LayeredBody<3>& struts() const { return *struts_; }
  const NodePositions& nodePositions() const { return *node_positions_; }  ///< m
  const Eigen::VectorXd& start() const { return start_; }                  ///< state at rest
  const Form& form() const { return form_; }

  int endNode(int end) const { return ends_[end]; }
  std::vector<int> heldNodes() const;  ///< three strut ends
  /// Corners of a strut's middle section.
  std::vector<int> middleNodes(int strut) const;
  /// Middle of a strut's sections from one end to the other, m.
  std::vector<Eigen::Vector3d> strutLine(int strut, const Eigen::VectorXd& state) const;
  /// Mean axial force in a strut, N, compression negative: the integral of its stress along the
  /// line through its ends, divided by its length.
  double strutForce(int strut, const Eigen::VectorXd& state) const;
  /// Whether a cable of makeParts() is of actin. Its numbers are those of TensegrityGeometry
  /// without the cut cables.
  bool isActin(int cable) const;

  /// The membrane at rest; its mesh_vertices are nodes.
  const SurfaceMesh& surface() const { return surface_; }

  /// All energies, with separate memory that begins at start().
  struct Parts {
    std::shared_ptr<Cables> cables;
    EquilibriumSystem::Terms terms;  ///< struts, cables, membrane, SpinStop
  };
  Parts makeParts() const { return makeParts(start_, 1); }

  /// Constraints: the three held ends, the tip's own entries, and nodes that follow the tip. Throws
  /// std::invalid_argument when a following node is held.
  Constraints constraints(const std::vector<int>& following) const;

  /// Position of a node in a state, m.
  Eigen::Vector3d position(int node, const Eigen::VectorXd& state) const {
    return (*node_positions_)[node] + state.segment<3>(3 * node);
  }

 private:
  Eigen::VectorXd makeStruts();
  void makeMembrane();
  Parts makeParts(const Eigen::VectorXd& start, double tightness) const;
  void settleStruts();
  void findForm();
  bool balance(Eigen::VectorXd& state, double tightness);
  bool refine(EquilibriumSystem& system, Eigen::VectorXd& state);
  void makeSurface();

  TensegrityConfig config_;
  TensegrityGeometry geometry_;
  std::shared_ptr<LayeredBody<3>> struts_;
  std::shared_ptr<NodePositions> node_positions_;
  std::vector<int> ends_;                   ///< node of each strut end
  std::vector<std::vector<int>> sections_;  ///< of each strut: first corner of each section
  std::vector<std::vector<int>> middles_;   ///< of each strut: corners of its middle section
  Membrane::Geometry membrane_;
  Eigen::VectorXd initial_, start_;  ///< states: initial, and at rest
  Form form_;
  SurfaceMesh surface_;
};

}  // namespace microinjection
