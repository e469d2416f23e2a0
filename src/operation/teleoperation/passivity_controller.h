#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"
#include "operation/teleoperation/contact_displacement.h"
#include "operation/teleoperation/energy_gate.h"
#include "operation/teleoperation/ripple_observer.h"
#include "operation/teleoperation/velocity_estimate.h"

namespace microinjection {

/// Energies are those at the hand. With position scale s (needle per hand) and force gain g (hand per tip) the hand's
/// power f v = (g F)(V / s) = (g / s) F V: the tip's power F V times a constant, so what is passive at the tip is
/// passive at the hand as long as s and g do not change within a contact. In joules of the tip the same loop would hide
/// the factor g / s (2e8 with the defaults), by which a fault of 1 pJ becomes 0.2 mJ in the hand.
struct PassivityConfig {
  bool enabled = true;
  double reserve = 1e-3;          ///< J, what the loop may give the hand before it has taken anything: the tolerance
  double contact_force = 0.01;    ///< N, below which the hand is in free motion and keeps no more than the reserve
  double storage_floor = 0.15;    ///< 1, share of force x way that what was touched stores at the least
  double storage_ceiling = 0.55;  ///< 1, share of force x way that it can give back at the most

  EnergyGateConfig gate;
  RippleConfig ripple;
  /// A channel with waves of its own lies between the hand and what is touched: what it stores is no share of force x
  /// way, nor is its ripple a spring's. Only the whole balance counts then. Not a key: it follows from the link.
  bool behind_channel = false;

  static PassivityConfig read(ConfigReader reader);
};

/// Time-domain passivity observer and controller of the port between the bridge and the hand
/// (Hannaford & Ryu, IEEE Trans. Robotics and Automation 18(1), 2002), in impedance causality: velocity in, force out.
///
/// The device holds a force f for a period, so what the hand gave in it is exactly -f (x_next - x): the observer counts
/// that, with the force that went out after all limits. Counting from the start alone has two known faults: what a cell
/// has dissipated over a minute would be a reserve that feeds a limit cycle for seconds; and a spring that gives back
/// more than it took is noticed only when it is nearly at rest. Both are met by following a reference energy (Ryu,
/// Preusche, Hannaford, Hirzinger 2005), the energy U that what is touched holds: it pushes with f and was pressed by p
/// since the touch, so
///     storage_floor f p <= U <= storage_ceiling f p
/// (a linear spring has 0.5, Hertz' contact 0.4, a membrane's cubic law 0.25). Energy above the upper bound plus the
/// reserve is forgotten; below the lower bound the controller acts.
class PassivityController {
 public:
  explicit PassivityController(const PassivityConfig& config)
      : config_(config),
        gate_(config.gate),
        ripple_(config.ripple),
        velocity_(config.gate.resolution),
        contact_(config.contact_force) {
    reset();
  }

  /// A new contact with nothing known: the reserve alone.
  void reset();

  /// Counts the period that has passed. `position` (m) of the hand now; dt (s).
  void observe(const Eigen::Vector3d& position, double dt);

  /// The period that is observed next was one in which the needle was held: what was touched has seen nothing of the
  /// hand's way.
  void pause() { paused_ = true; }

  /// The force (N, on the hand) to render instead of `wanted`; `touched`: the force of what is touched, before any
  /// ramp.
  Eigen::Vector3d control(const Eigen::Vector3d& wanted, const Eigen::Vector3d& touched, double dt);

  /// What goes out for the next period (N), after every limit.
  void setRendered(const Eigen::Vector3d& force) { rendered_ = force; }

  double energy() const { return total_; }  ///< J, taken from the hand since the start; the observed energy
  const Eigen::Vector3d& velocity() const { return velocity_.value(); }  ///< m/s, of the hand
  /// N/m, force over way of what is touched; 0: nothing, infinite: touched where the hand stands.
  double stiffness() const { return contact_.stiffness(); }
  bool acting() const { return gate_.acting(); }  ///< the last force was not the one that was wanted

 private:
  void followContact(const Eigen::Vector3d& touched, double dt);

  PassivityConfig config_;
  EnergyGate gate_;
  RippleObserver ripple_;
  VelocityEstimate velocity_;
  double balance_ = 0;  ///< J, reserve included, ceiling applied
  double total_ = 0;    ///< J
  ContactDisplacement contact_;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();      ///< m
  Eigen::Vector3d rendered_ = Eigen::Vector3d::Zero();  ///< N
  double free_ = 0;                                     ///< s, without a touch
  bool known_ = false;                                  ///< there is a last position
  bool paused_ = false;
};

}  // namespace microinjection
