#pragma once

#include <Eigen/Core>
#include <optional>

#include "operation/link/link_config.h"
#include "operation/link/link_packet.h"

namespace microinjection {

/// The hand's end of the link. Each epoch of waves lasts from an engagement to the next hold. It
/// ends for good when the rig's last packet is older than the time-out, or when the rig reports
/// that it no longer follows. The bridge then holds, and the next engagement begins a new epoch.
class LinkLeader {
 public:
  /// Epochs count up from `first_epoch`. It must exceed every epoch of earlier runs: use a clock's
  /// nanoseconds.
  LinkLeader(const LinkConfig& config, double position_scale, double force_gain, std::uint64_t first_epoch);

  void receive(const LinkPacket& packet);
  /// Advances by a period dt (s), before the bridge's step. Returns the force (N, at the hand) to
  /// feed back: zero while the needle does not follow, empty without a valid link.
  std::optional<Eigen::Vector3d> step(double dt);
  /// Sets the bridge's target of the needle (m, `world`), after its step; empty: hold.
  void setTarget(const std::optional<Eigen::Vector3d>& target);
  /// The tip (m, `world`) in the rig's last packet; empty: no valid link.
  std::optional<Eigen::Vector3d> needle() const;
  LinkPacket packet();  ///< to send after setTarget

  double packetAge() const { return packet_age_; }        ///< s, since the rig's last packet
  double margin() const { return wave_.margin(); }        ///< J
  double roundTrip() const { return wave_.roundTrip(); }  ///< periods

 private:
  LinkConfig config_;
  WaveLeader wave_;
  LinkPacket last_received_, outgoing_;
  Eigen::Vector3d target_ = Eigen::Vector3d::Zero();  // m, at the hand's scale
  double packet_age_;                                 // s
  double waiting_time_ = 0;                           // s, until the rig follows
  bool followed_ = false;                             // the rig has followed in this epoch
  bool lost_ = false;                                 // this epoch is over
};

}  // namespace microinjection
