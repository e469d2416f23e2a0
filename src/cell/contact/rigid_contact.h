#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "cell/contact/rigid_surface.h"
#include "cell/mechanics/energy_term.h"
#include "cell/mechanics/layered_body.h"

namespace microinjection {

struct RigidContactConfig {
  enum class Mode { kSticking, kSliding };
  Mode mode = Mode::kSticking;
  double friction = 0;                               ///< Coulomb's coefficient, >= 0, of kSliding
  double slip_range = 0;                             ///< m, >= 0, elastic slip at which it slides; 0: by the penalty
  double adhesion = 0;                               ///< J/m^2, >= 0, energy of separation per area
  double adhesion_range = 0;                         ///< m, > 0 with adhesion: gap of the largest traction
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m, of the surface's frame at first contact
  double penalty = 0;                                ///< Pa/m, traction per penetration, > 0
  /// m, penetration over which the penalty grows to e times itself, so that it stays stiff beside any pressure; 0: it
  /// is constant. For sliding without friction.
  double hardening = 0;
  /// Whether each component of the place follows that of the tip's translation; else it stays at the origin's.
  std::array<bool, 3> moves = {true, true, true};
};

/// Unilateral contact of a body's outer surface with a rigid pipette, a needle's end or a mouth, by penalty at the
/// surface's quadrature points (Wriggers, "Computational contact mechanics", ch. 6); tractions are
/// per undeformed area.
///
/// Sliding: energy penalty/2 gap^2 where the gap is negative. Because the traction is per undeformed area, a surface
/// that yields like a free one may flow along the pipette under a high pressure and wrinkle; `hardening` keeps it from
/// yielding. Coulomb's friction also has an
/// incremental potential, bounded by the normal traction of the previous step. A point slides once it has
/// slipped by `slip_range` elastically. With the penalty as its stiffness instead, sticking and sliding
/// points differ so much that Newton's method ends at a tenth of a cell's diameter. Sticking: a point
/// sticks to its first contact point until its traction is tensile. Within the step of first
/// contact it slides; afterwards it is moved back to where its path met the tip.
///
/// Adhesion: points that were in contact are pulled back over a gap g > 0 by the traction G/d^2 g
/// exp(-g/d) along the tip's normal, with the separation energy G = `adhesion` and d =
/// `adhesion_range` (Xu and Needleman, "Numerical simulations of fast crack growth in brittle
/// solids", 1994, normal part); at most G/(e d). With sticking, it begins when a point is released.
/// It ends at a large gap, where its traction is negligible.
template <int Dim>
class RigidContact : public EnergyTerm {
 public:
  RigidContact(const LayeredBody<Dim>& body, std::shared_ptr<const RigidSurface> surface,
               const RigidContactConfig& config);

  int elementCount() const override { return static_cast<int>(facets_.size()); }
  const std::vector<int>& entries(int facet) const override { return facets_[facet].entries; }
  bool evaluate(int facet, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override;
  bool isNonsmooth(int facet) const override { return facets_[facet].near; }
  bool beginStep(double duration) override;
  bool settle(const Eigen::VectorXd& state) override;
  void accept(const Eigen::VectorXd& state) override;
  void reset() override;

  int touchingPoints() const;  ///< quadrature points in contact at the last accepted state

  /// Where the surface is pressed against the pipette at a state: the circle's radius (m), a mean with the normal
  /// traction as weight, its spread (m, standard deviation), and the force along z that the contact exerts on the body
  /// (N, of the whole body). Nothing touches: all zero.
  struct Ring {
    double radius = 0, spread = 0, force = 0;
  };
  Ring ring(const Eigen::VectorXd& state) const;

  /// m, the smallest distance of the surface from the pipette at a state, were the tip translated by this (m).
  double clearance(const Eigen::VectorXd& state, const Eigen::Vector3d& translation) const;

  /// Largest penetration of the tip into the surface at the last equilibrium, m. It should be small
  /// against the tip's radius.
  double penetration() const { return deepest_; }

 private:
  using Vector = Eigen::Matrix<double, Dim, 1>;
  using Matrix = Eigen::Matrix<double, Dim, Dim>;
  struct Memory {
    Vector last = Vector::Zero();  ///< m, relative to the tip, at the end of the last step
    bool touching = false;         ///< `anchor` is valid
    /// m, relative to the tip: position without tangential (sticking: any) spring force.
    Vector anchor = Vector::Zero();
    Vector normal = Vector::Zero();  ///< out of the tip, at the last settle()
    double traction = 0;             ///< Pa, normal, at the last settle()
    bool bonded = false;             ///< was in contact and is within the range of adhesion
  };
  struct Point {
    Vector undeformed = Vector::Zero();  ///< m, relative to the tip's origin
    double weight = 0;                   ///< m^2
    Eigen::VectorXd shape;               ///< of the facet's nodes
    Memory memory, accepted;             ///< of this step, and of the last accepted one
  };
  struct Facet {
    std::vector<int> entries;  ///< node by node, then those of the tip that the surface follows
    int nodes;
    std::vector<Point> points;
    bool near = false;  ///< to the tip, undeformed: its points may come into contact
  };
  struct Local {
    double energy = 0;
    Vector gradient = Vector::Zero();
    Matrix hessian = Matrix::Zero();
  };

  void addFacet(const LayeredBody<Dim>& body, const typename QuadraticMesh<Dim>::Facet& facet);
  Vector relative(const Facet& facet, const Point& point, const Eigen::VectorXd& state) const;
  /// Of the penalty, per undeformed area, at a penetration (m).
  struct Pressing {
    double energy, traction, stiffness;  ///< J/m^2, Pa, Pa/m
  };
  Pressing pressing(double penetration) const;
  bool contribution(const Point& point, const Vector& at, Local& local) const;
  double slipStiffness(const Memory& memory) const;  ///< Pa/m
  void addFriction(const Point& point, const Vector& at, Local& local) const;
  void addAdhesion(const Point& point, const Vector& at, Local& local) const;
  bool settle(Memory& memory, const Vector& at) const;
  double gap(const Vector& at, Vector& normal, Matrix& curvature) const;

  std::shared_ptr<const RigidSurface> surface_;
  RigidContactConfig config_;
  std::vector<int> moving_;  ///< components of a Vector that follow the tip
  std::vector<Facet> facets_;
  double deepest_ = 0;  ///< m, penetration at the last equilibrium
};

}  // namespace microinjection
