#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "cell/mechanics/energy_term.h"
#include "cell/tensegrity/cables.h"
#include "cell/tensegrity/tensegrity_config.h"

namespace microinjection {

/// A closed thin membrane on linear triangles under a constant internal pressure. Energy, J, with
/// the area A0 at rest
///
///     sum A0 (h/2 E : C : E + gamma tr E + h retardation/(2 dt) (E - E_n) : C : (E - E_n)) - p V,
///
/// E the Green-Lagrange strain in the triangle's plane relative to `rest`, C plane stress
/// (St-Venant-Kirchhoff), h the thickness, gamma the tension at rest, p = 2 gamma / radius
/// (Laplace), V the enclosed volume. The last term of the sum is Kelvin-Voigt's in a load step of
/// finite duration dt that begins at E_n (implicit Euler). The pressure is constant, as if the
/// content could flow into a reservoir without resistance; a real cell's volume is nearly constant.
class Membrane : public EnergyTerm {
 public:
  struct Geometry {
    std::vector<int> nodes;                     ///< of the state, of each vertex
    std::vector<Eigen::Vector3d> rest;          ///< m, of each vertex, on the sphere
    std::vector<std::array<int, 3>> triangles;  ///< of vertices, counter-clockwise seen from outside
    double radius = 0;                          ///< m
  };

  /// `start`: initial state of the memory, as if held for an infinite time.
  Membrane(std::shared_ptr<const NodePositions> node_positions, const Geometry& geometry, const MembraneConfig& config,
           const Eigen::VectorXd& start);

  int elementCount() const override { return static_cast<int>(facets_.size()); }
  const std::vector<int>& entries(int facet) const override { return facets_[facet].entries; }
  bool evaluate(int facet, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override;
  /// True when the membrane is viscous and `duration` is finite.
  bool beginStep(double duration) override;
  void accept(const Eigen::VectorXd& state) override;
  void reset() override;

 private:
  struct Facet {
    std::array<int, 3> nodes;
    std::vector<int> entries;
    double area;                              ///< A0, m^2
    Eigen::Matrix<double, 3, 2> gradients;    ///< of the shape functions in the triangle's plane at rest, 1/m
    Eigen::Vector3d before, accepted, start;  ///< strain: (E11, E22, 2 E12)
  };
  Eigen::Matrix3d positions(const Facet& facet, const Eigen::VectorXd& state) const;
  static Eigen::Vector3d strain(const Eigen::Matrix<double, 3, 2>& F);

  std::shared_ptr<const NodePositions> node_positions_;
  std::vector<Facet> facets_;
  Eigen::Matrix3d stiffness_;  ///< h C, N/m
  double tension_, pressure_, retardation_time_;
  double viscous_ = 0;  ///< retardation time over the present step's duration
};

}  // namespace microinjection
