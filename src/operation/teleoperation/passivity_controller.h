#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"
#include "operation/teleoperation/contact_displacement.h"
#include "operation/teleoperation/energy_gate.h"
#include "operation/teleoperation/ripple_observer.h"
#include "operation/teleoperation/velocity_estimate.h"

namespace microinjection {

/// All energies are at the hand's scale. With position scale s (needle per hand) and force gain g
/// (hand per tip) the hand's power is f v = (g F)(V / s) = (g / s) F V, a constant times the tip's
/// power F V. A loop that is passive at the tip is therefore passive at the hand, as long as s and
/// g do not change within a contact. Joules of the tip would hide the factor g / s (2e8 with the
/// defaults), which turns an error of 1 pJ into 0.2 mJ at the hand.
struct PassivityConfig {
  bool enabled = true;
  double reserve = 1e-3;          ///< J, energy that the loop may give the hand before it took any: the tolerance
  double contact_force = 0.01;    ///< N, below which the hand is in free motion and the balance is at most the reserve
  double storage_floor = 0.15;    ///< 1, smallest share of force x displacement that the touched body stores
  double storage_ceiling = 0.55;  ///< 1, largest share of force x displacement that it can return

  EnergyGateConfig gate;
  RippleConfig ripple;
  /// A wave channel lies between the hand and the touched body. Its stored energy is no share of
  /// force x displacement, and its ripple is not that of a spring, so only the whole balance
  /// counts. Not a key: it follows from the link.
  bool behind_channel = false;

  static PassivityConfig read(ConfigReader reader);
};

/// Time-domain passivity observer and controller of the port between the bridge and the hand
/// (Hannaford & Ryu, IEEE Trans. Robotics and Automation 18(1), 2002), in impedance causality:
/// velocity in, force out.
///
/// The device holds a force f for a period, so the hand's work in it is exactly -f (x_next - x).
/// The observer sums this work with the force after all limits. A plain sum from the start has two
/// known faults:
/// - The energy that a cell dissipated over a minute would be a reserve that feeds a limit cycle
///   for seconds.
/// - A spring that returns more than it took is detected only when it is nearly at rest.
///
/// Both are avoided with a reference energy (Ryu, Preusche, Hannaford, Hirzinger 2005), the energy
/// U stored in the touched body. It pushes with f and was displaced by p since contact, so
///     storage_floor f p <= U <= storage_ceiling f p
/// (a linear spring has 0.5, a Hertz contact 0.4, a membrane's cubic law 0.25). Energy above the
/// upper bound plus the reserve is discarded; below the lower bound the controller acts.
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

  /// Begins anew: the balance is the reserve.
  void reset();

  /// Counts the period dt (s) that has passed. `position` (m) is the hand's at its end.
  void observe(const Eigen::Vector3d& position, double dt);

  /// Marks the period that is observed next: the needle was held in it, so the hand's motion did
  /// not reach the touched body.
  void pause() { paused_ = true; }

  /// Returns the force (N, on the hand) to render instead of `wanted`. `contact_force` (N) is the
  /// touched body's, before any ramp.
  Eigen::Vector3d control(const Eigen::Vector3d& wanted, const Eigen::Vector3d& contact_force, double dt);

  /// Sets the force (N) of the next period, after every limit.
  void setRendered(const Eigen::Vector3d& force) { rendered_ = force; }

  double energy() const { return total_; }  ///< J, observed energy: taken from the hand since the start
  const Eigen::Vector3d& velocity() const { return velocity_.value(); }  ///< m/s, of the hand
  /// N/m, of the touched body, see ContactDisplacement::stiffness().
  double stiffness() const { return contact_.stiffness(); }
  bool acting() const { return gate_.acting(); }  ///< the last force differed from the wanted one

 private:
  void followContact(const Eigen::Vector3d& contact_force, double dt);

  PassivityConfig config_;
  EnergyGate gate_;
  RippleObserver ripple_;
  VelocityEstimate velocity_;
  double balance_ = 0;  ///< J, reserve included, ceiling applied
  double total_ = 0;    ///< J
  ContactDisplacement contact_;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();      ///< m
  Eigen::Vector3d rendered_ = Eigen::Vector3d::Zero();  ///< N
  double free_ = 0;                                     ///< s, without contact
  bool has_last_ = false;                               ///< last_ is set
  bool paused_ = false;
};

}  // namespace microinjection
