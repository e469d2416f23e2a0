#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "base/config_reader.h"
#include "operation/teleoperation/energy_gate.h"
#include "operation/teleoperation/teleoperation_packet.h"
#include "operation/teleoperation/velocity_estimate.h"

namespace microinjection {

struct TwoPortConfig {
  bool enabled = true;       ///< false: values only, nothing controlled (to compare)
  double reserve = 1e-3;     ///< J a direction, what may come out before anything went in: the tolerance
  double speed_limit = 0.3;  ///< m/s at the hand's scale, at which the follower makes up for what was lost or withheld
  double timeout = 0.3;      ///< s without a packet: the follower holds, the leader renders nothing

  EnergyGateConfig gate;  ///< of the leader

  static TwoPortConfig read(ConfigReader reader);
};

/// The receiving half of either side: the newest value, the largest energy, and how old they are.
class PacketInbox {
 public:
  void receive(const TeleoperationPacket& packet);
  void age(double dt) { age_ += dt; }
  /// Empty before the first packet and when the newest is older than `timeout` (s).
  std::optional<Eigen::Vector3d> value(double timeout) const;
  double energy() const { return energy_; }  ///< J

 private:
  std::uint64_t sequence_ = 0;
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
  double energy_ = 0;
  double age_ = 0;
};

/// Time-domain passivity of the channel between bridge and rig (Ryu, Artigas & Preusche, Mechatronics 20, 2010): each
/// side counts the energy that enters the channel there and tells the other with every packet, and neither lets more
/// out than has entered at the other side:
///     out at the follower (t) <= in at the leader (t - delay) + reserve, and the other way round.
/// Since in(t - delay) <= in(t), the channel is passive for every delay, constant or not, without knowing it. The
/// energies are sums since the start that never fall, so a lost, late or repeated packet makes the receiver believe in
/// less energy than there is: the safe side. All in the hand's units (see passivity_controller.h): the needle's
/// positions over the position scale, so that the clutch moves nothing, and tip forces times the force gain.
///
/// Leader: position in, force out; an EnergyGate keeps in what must not come out.
class LeaderPort {
 public:
  explicit LeaderPort(const TwoPortConfig& config)
      : config_(config), gate_(config.gate), velocity_(config.gate.resolution) {}

  void receive(const TeleoperationPacket& packet) { inbox_.receive(packet); }
  /// `position` (m) of the hand's side now. Returns the force (N) to feed back; empty: nothing to trust.
  std::optional<Eigen::Vector3d> step(const Eigen::Vector3d& position, double dt);
  /// To send after each step.
  const TeleoperationPacket& packet() const { return outgoing_; }

  double energyOut() const { return out_; }                 ///< J
  double energyIn() const { return outgoing_.energy; }      ///< J
  double margin() const { return inbox_.energy() - out_; }  ///< J, of the direction that ends here; at least -reserve

 private:
  TwoPortConfig config_;
  EnergyGate gate_;
  PacketInbox inbox_;
  VelocityEstimate velocity_;
  TeleoperationPacket outgoing_;
  double out_ = 0;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();   ///< m
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  ///< N, fed back in the period
  bool known_ = false;
};

/// Follower: force in, position out; what must not come out is not moved. It goes where the leader was, and makes up
/// for what it lagged behind as soon as there is energy, so that no drift stays.
class FollowerPort {
 public:
  explicit FollowerPort(const TwoPortConfig& config) : config_(config) {}

  void receive(const TeleoperationPacket& packet) { inbox_.receive(packet); }
  /// `force` (N) of what is touched, after the move of the step before. Returns where to be (m); empty: hold.
  std::optional<Eigen::Vector3d> step(const Eigen::Vector3d& force, double dt);
  const TeleoperationPacket& packet() const { return outgoing_; }

  double energyOut() const { return out_; }                      ///< J
  double energyIn() const { return outgoing_.energy; }           ///< J
  double margin() const { return inbox_.energy() - out_; }       ///< J
  const Eigen::Vector3d& position() const { return position_; }  ///< m

 private:
  Eigen::Vector3d allowed(const Eigen::Vector3d& move, const Eigen::Vector3d& force) const;

  TwoPortConfig config_;
  PacketInbox inbox_;
  TeleoperationPacket outgoing_;
  double out_ = 0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d move_ = Eigen::Vector3d::Zero();      ///< m, of the step before
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();     ///< N, of the step before
  bool begun_ = false;
};

}  // namespace microinjection
