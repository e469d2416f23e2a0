#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"
#include "operation/link/link_packet.h"
#include "operation/link/wave_receiver.h"
#include "operation/teleoperation/contact_displacement.h"

namespace microinjection {

/// Averages the round-trip time of packets from the other side's echoes.
class RoundTrip {
 public:
  void receive(std::uint64_t sent, std::uint64_t echo) {
    if (echo > 0) periods_ += (static_cast<double>(sent - echo) - periods_) / kAverage;
  }
  double periods() const { return periods_; }

 private:
  static constexpr double kAverage = 200;
  double periods_ = 0;
};

struct WaveConfig {
  double impedance = 20;        ///< N s/m, b
  double stiffness = 1000;      ///< N/m, of the spring between the hand and the leader's port
  double lateness = 6e-3;       ///< s, delay of the touched body's force at the rig: needle, sensor or model, periods
  double damping = 20;          ///< N s/m, largest damping at the rig against that delay
  double matching = 1;          ///< 1, damping at the needle's end over the impedance, which reduces reflected waves
  double contact_force = 0.01;  ///< N, below which there is no contact
  WaveReceiverConfig receiver;

  static WaveConfig read(ConfigReader reader);
};

/// Wave variables (Anderson & Spong 1989; Niemeyer & Slotine 1991, with their integrals 1998) for
/// the channel between bridge and rig. With v the velocity of a port and f the force that it exerts
/// on the side behind it,
///     u = (b v + f) / sqrt(2 b)   towards the needle,
///     w = (b v - f) / sqrt(2 b)   towards the hand:
///     f v = u^2 / 2 - w^2 / 2,
/// so the channel is passive for any delay as long as no wave leaves it with more energy than
/// entered. WaveReceiver guarantees this. At rest, when reflections have decayed, u and w are
/// constant and f is the same on both sides. The packets carry the integrals
///     sqrt(2 b) int u = b x + int f,
/// so a lost packet causes no drift. With a delay T in each direction, a held force f leaves the
/// needle f T / b behind the hand: the channel is a spring of b / T. All quantities are at the
/// hand's scale (see passivity_controller.h).
///
/// A resting hand reflects every wave (u = -w). So does a needle in free motion (w = u) or on a
/// stiff body (w = -u). Between such ends waves travel back and forth, and for seconds neither
/// positions nor forces of the two sides agree. On a soft body of stiffness k, a needle's end with
/// damping d reflects, at the angular frequency o,
///     w / u = (b - d - k / (i o)) / (b + d + k / (i o)):
/// nothing in free motion with d = b, and little where o is larger than k / 2 b (Niemeyer &
/// Slotine's matching). The hand then feels d while it moves.
///
/// Leader: a spring between the hand and the port keeps the encoder's steps out of the waves.
class WaveLeader {
 public:
  explicit WaveLeader(const WaveConfig& config) : config_(config), receiver_(config.receiver) {}

  /// Begins anew at this position of the hand's side (m), without force.
  void reset(const Eigen::Vector3d& position);
  void receive(const TeleoperationPacket& packet);
  /// Advances by dt (s) with the present `position` (m) of the hand's side. Returns the force (N)
  /// on it.
  Eigen::Vector3d step(const Eigen::Vector3d& position, double dt);
  const TeleoperationPacket& packet() const { return outgoing_; }  ///< to send after each step
  double margin() const { return receiver_.margin(); }             ///< J
  double roundTrip() const { return round_trip_.periods(); }       ///< periods

 private:
  WaveConfig config_;
  WaveReceiver receiver_;
  RoundTrip round_trip_;
  TeleoperationPacket outgoing_;
  Eigen::Vector3d port_ = Eigen::Vector3d::Zero();  ///< m
};

/// Follower: force in, position out. A spring k whose force is late by t generates energy like a
/// negative damping of k t (N s/m). The follower adds that damping and the matching's.
class WaveFollower {
 public:
  explicit WaveFollower(const WaveConfig& config)
      : config_(config), receiver_(config.receiver), contact_(config.contact_force) {}

  /// Begins anew. begin() may set the position (m) later.
  void reset(const Eigen::Vector3d& position);
  void begin(const Eigen::Vector3d& position) { position_ = position; }
  void receive(const TeleoperationPacket& packet);
  /// Advances by dt (s) with the touched body's `force` (N) on the needle. Returns the target (m).
  const Eigen::Vector3d& step(const Eigen::Vector3d& force, double dt);
  const TeleoperationPacket& packet() const { return outgoing_; }
  double margin() const { return receiver_.margin(); }           ///< J
  const Eigen::Vector3d& position() const { return position_; }  ///< m

 private:
  WaveConfig config_;
  WaveReceiver receiver_;
  RoundTrip round_trip_;
  TeleoperationPacket outgoing_;
  ContactDisplacement contact_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();  ///< m
};

}  // namespace microinjection
