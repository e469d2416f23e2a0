#pragma once

#include <Eigen/Core>
#include <optional>

#include "operation/teleoperation/link_config.h"
#include "operation/teleoperation/link_packet.h"

namespace microinjection {

/// The hand's end of the link: an epoch of waves from each taking up of the hand to the next hold. It is over for good
/// when the rig has not been heard for the time-out or says that it does not follow any more; the bridge then holds and
/// begins a new one.
class LinkLeader {
 public:
  /// Epochs count up from `first_epoch`, which must be larger than any of an earlier run: nanoseconds of a clock.
  LinkLeader(const LinkConfig& config, double position_scale, double force_gain, std::uint64_t first_epoch);

  void receive(const LinkPacket& packet);
  /// One period of dt (s), before the bridge's step. Returns the force (N, at the hand) to feed back; zero while
  /// nothing follows; empty: no valid link.
  std::optional<Eigen::Vector3d> step(double dt);
  /// Where the bridge wants the needle (m, `world`), after its step; empty: hold.
  void setTarget(const std::optional<Eigen::Vector3d>& target);
  /// The tip as the rig told it last (m, `world`); empty: no valid link.
  std::optional<Eigen::Vector3d> needle() const;
  LinkPacket packet();  ///< to send after setTarget

  double age() const { return age_; }                     ///< s, since the rig was heard
  double margin() const { return wave_.margin(); }        ///< J
  double roundTrip() const { return wave_.roundTrip(); }  ///< periods

 private:
  LinkConfig config_;
  WaveLeader wave_;
  LinkPacket heard_, outgoing_;
  Eigen::Vector3d target_ = Eigen::Vector3d::Zero();  // m, at the hand's scale
  double age_;                                        // s
  double waited_ = 0;                                 // s, for the rig to follow
  bool followed_ = false;                             // the rig has, in this epoch
  bool lost_ = false;                                 // this epoch is over
};

}  // namespace microinjection
