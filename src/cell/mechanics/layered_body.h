#pragma once

#include <Eigen/Core>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "cell/material/material.h"
#include "cell/mechanics/energy_term.h"
#include "cell/mechanics/reference_element.h"
#include "cell/mesh/quadratic_mesh.h"

namespace microinjection {

template <int Dim, int N>
class ElementSum;

/// Treatment of states with inverted elements (det F <= 0 at a quadrature point). Small strain
/// always allows them, and materials that resist inversion never do.
enum class Inversion {
  kRefused,  ///< such a state is not admissible
  kAllowed   ///< the material's formulas give the energy
};

/// Thrown for a mesh with an element that is not positively oriented. It is a type of its own because a swept mesh that
/// is bent too far towards a contact point fails in this way: callers then tell the user that the needle is too far
/// out.
class InvertedElement : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Strain energy of a body of layers on finite elements: in space (Dim = 3, displacements x, y, z)
/// or, for a body of revolution deformed without twist, in its section (Dim = 2, displacements r,
/// z; volumes are those of the whole body).
///
/// With a pressure p per element or vertex the dilatational energy kappa/2 g^2 of the material
/// becomes p g - p^2 / (2 kappa), stationary in p: the same solution, without volumetric locking.
///
/// The element is chosen at run time, because only measurements tell them apart. Error of the force, and time in space,
/// on equal meshes (neo-Hookean disc, 5 um, Poisson's ratio 0.49; doc/reference/benchmarks.md, Elements):
///
///     element    section    space         time
///     P1         +37.7 %    +75.7 %       0.14 s    the paper's; locks
///     MINI        +9.0 %    +22.6 %       1.5 s
///     P1-P1       +6.7 %    +18.5 %       1 s       stabilised
///     P2          +3.5 %    no solution
///     P2-P0       -0.1 %     +2.7 %       3.8 s     the default: its pressure is eliminated in the element
///     P2-P1       -0.1 %     +1.3 %       56 s      continuous pressures, so the matrix is indefinite
///
/// Space and section share this class, since they differ in Strain<Dim> and in the weights only: a section's
/// displacement over r is its hoop strain, and its weights are 2 pi r times those of the triangle.
///
/// The state's layout:
///
///     | u of node 0 | u of node 1 | ... | bubbles (MINI) | p_0 p_1 ... | t_x t_y t_z |
///       Dim entries                       one an element   in units of    the tip's
///                                                          pressureUnit()
///
/// A pressure in these units is a length like all other entries, so that one matrix holds both. The body has no history
/// (beginStep, accept and reset do nothing; ViscousStress has that of a viscoelastic body). It is immutable and can be
/// shared between threads and systems.
template <int Dim>
class LayeredBody : public EnergyTerm {
 public:
  using Materials = std::vector<std::shared_ptr<const Material>>;  ///< of each layer

  /// Throws InvertedElement when an element is not positively oriented, or is of a layer without a material.
  LayeredBody(QuadraticMesh<Dim> mesh, ElementKind kind, Materials materials,
              Inversion inversion = Inversion::kRefused);

  const QuadraticMesh<Dim>& mesh() const { return mesh_; }
  const Materials& materials() const { return materials_; }
  ElementKind kind() const { return kind_; }
  int nodeCount() const { return node_count_; }  ///< nodes of displacement, bubbles at the end
  int pressureCount() const { return pressure_count_; }
  int stateSize() const { return Dim * node_count_ + pressure_count_ + 3; }
  int tipEntry() const { return stateSize() - 3; }  ///< the first of the tip's three entries of the state
  bool isLinear() const;                            ///< the materials of all layers are
  /// Pa/m: the largest shear modulus of the layers over the mean size of an element, so that the coupling of pressures
  /// and displacements is of the stiffness's size.
  double pressureUnit() const { return pressure_unit_; }

  int elementCount() const override { return static_cast<int>(entries_.size()); }
  /// Displacements component by component, then pressures.
  const std::vector<int>& entries(int element) const override { return entries_[element]; }
  bool evaluate(int element, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override;

  /// Deformation gradient F at a quadrature point; of a section in the directions (r, theta, z).
  Eigen::Matrix3d deformationGradient(int element, int point, const Eigen::VectorXd& state) const;
  int pointCount() const { return point_count_; }  ///< per element

  /// Smallest det F of all quadrature points: 1 at rest, <= 0 where an element is inverted there.
  double smallestJacobian(const Eigen::VectorXd& state) const;

  /// Undeformed volume of the body, m^3.
  double volume() const;

  /// Calls function(N) with the number of nodes of an element as a constant, for terms on the same
  /// elements.
  template <typename Function>
  auto withNodes(Function&& function) const;
  template <int N>
  using Derivatives = Eigen::Map<const Eigen::Matrix<double, N, 3>>;
  /// Derivatives of the shape functions, 1/m: see Strain. @pre N is what withNodes() passes
  template <int N>
  Derivatives<N> derivatives(int element, int point) const;
  double weight(int element, int point) const { return weights_[element * point_count_ + point]; }  ///< m^3

 private:
  void addElement(int index, const std::vector<ReferenceElement::Point>& quadrature);
  template <int N>
  Eigen::Matrix<double, N, Dim> displacement(int element, const Eigen::VectorXd& state) const;

  template <int N>
  bool evaluateNodes(int element, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const;
  template <int N, int M>
  void addPressure(int element, const Material::Kinematics* at, const Eigen::VectorXd& state, ElementSum<Dim, N>& sum,
                   LocalEnergy& result) const;

  QuadraticMesh<Dim> mesh_;
  ElementKind kind_;
  Materials materials_;
  Inversion inversion_;
  int nodes_of_element_ = 0;
  int node_count_ = 0;
  int pressure_count_ = 0;
  int point_count_ = 0;
  double pressure_unit_ = 1;
  std::vector<std::vector<int>> entries_;        ///< of each element
  std::vector<double> weights_;                  ///< m^3, of each point of each element
  std::vector<double> derivatives_;              ///< 1/m, (nodes x 3) of each point of each element: see Strain
  std::vector<Eigen::VectorXd> pressure_shape_;  ///< at the quadrature points
};

template <int Dim>
template <typename Function>
auto LayeredBody<Dim>::withNodes(Function&& function) const {
  if (isQuadratic(kind_)) return function(std::integral_constant<int, QuadraticMesh<Dim>::kNodes>());
  if (kind_ == ElementKind::kMini) return function(std::integral_constant<int, Dim + 2>());
  return function(std::integral_constant<int, Dim + 1>());
}

template <int Dim>
template <int N>
typename LayeredBody<Dim>::template Derivatives<N> LayeredBody<Dim>::derivatives(int element, int point) const {
  return Derivatives<N>(derivatives_.data() + static_cast<std::size_t>(element * point_count_ + point) * N * 3);
}

}  // namespace microinjection
