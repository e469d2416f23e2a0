#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"
#include "operation/teleoperation/contact_displacement.h"
#include "operation/teleoperation/teleoperation_packet.h"
#include "operation/teleoperation/wave_receiver.h"

namespace microinjection {

/// How long a packet takes there and back, as the other side's echoes tell.
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
  double impedance = 20;    ///< N s/m, b
  double stiffness = 1000;  ///< N/m, between the hand and the leader's end of the channel
  double lateness = 6e-3;   ///< s, by which what is touched answers late at the rig: needle, sensor or model, periods
  double damping = 20;      ///< N s/m, the most that is rendered at the rig against that
  double matching = 1;      ///< 1, damping at the needle's end over the impedance, so that waves do not go to and fro
  double contact_force = 0.01;  ///< N, below which nothing is touched
  WaveReceiverConfig receiver;

  static WaveConfig read(ConfigReader reader);
};

/// Wave variables (Anderson & Spong 1989; Niemeyer & Slotine 1991, with their integrals 1998) for the channel between
/// bridge and rig. With v the velocity of a port and f the force that it puts into what lies behind it,
///     u = (b v + f) / sqrt(2 b)   towards the needle,   w = (b v - f) / sqrt(2 b)   towards the hand:
///     f v = u^2 / 2 - w^2 / 2,
/// so that the channel is passive for any delay as long as no wave comes out with more energy than went in, which
/// WaveReceiver keeps. At rest, once no wave goes to and fro any more, u and w are constant and f is the same on both
/// sides.
/// Sent are the integrals sqrt(2 b) int u = b x + int f, so that a lost packet moves nothing. With the delay T there
/// and back each, a held force f leaves the needle f T / b behind the hand: the channel is a spring of b / T. All at
/// the hand's scale (see passivity_controller.h).
///
/// A hand that stands sends every wave back (u = -w), and so does a needle that touches nothing (w = u) or something
/// stiff (w = -u): between such ends waves go to and fro, and for seconds the needle is not where the hand is nor the
/// force at the hand the needle's. Against a soft thing k a needle's end that is damped by d sends back, at the angular
/// frequency o, w / u = (b - d - k / (i o)) / (b + d + k / (i o)): nothing in free motion with d = b, little where o is
/// larger than k / 2 b (Niemeyer & Slotine's matching). The hand then feels d as long as it moves.
///
/// Leader: between the hand and the port lies a spring, which keeps the encoder's steps out of the waves.
class WaveLeader {
 public:
  explicit WaveLeader(const WaveConfig& config) : config_(config), receiver_(config.receiver) {}

  /// The hand's side begins anew here (m), without force.
  void reset(const Eigen::Vector3d& position);
  void receive(const TeleoperationPacket& packet);
  /// `position` (m) of the hand's side now. Returns the force (N) on it.
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

/// Follower: force in, position out. A spring k that answers late by t is active by k t (N s/m); as much damping is put
/// beside it, and the matching's.
class WaveFollower {
 public:
  explicit WaveFollower(const WaveConfig& config)
      : config_(config), receiver_(config.receiver), contact_(config.contact_force) {}

  /// Everything anew; the position (m) may be given later, by begin().
  void reset(const Eigen::Vector3d& position);
  void begin(const Eigen::Vector3d& position) { position_ = position; }
  void receive(const TeleoperationPacket& packet);
  /// `force` (N) of what is touched, on the needle. Returns where to be (m).
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
