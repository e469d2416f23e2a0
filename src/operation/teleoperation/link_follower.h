#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "operation/teleoperation/link_config.h"
#include "operation/teleoperation/link_packet.h"

namespace microinjection {

/// The rig's end of the link: where the needle shall go, from the hand's waves and the tip's force. It begins with each
/// epoch where the needle is, and holds when the hand's side has not been heard for the time-out, wants it to hold, or
/// needle, force or controller are not valid; an epoch that it has released is over.
class LinkFollower {
 public:
  struct Input {
    std::optional<Eigen::Vector3d> needle;  ///< m, tip in `world`
    std::optional<Eigen::Vector3d> force;   ///< N, of the cell on the tip, `world`
    bool controller = true;                 ///< what moves the needle there is alive
  };

  explicit LinkFollower(const LinkConfig& config);

  void receive(const LinkPacket& packet);
  /// One period of dt (s): where the tip shall go (m, `world`); empty: hold.
  std::optional<Eigen::Vector3d> step(const Input& input, double dt);
  LinkPacket packet();  ///< to send after each step
  /// Why the last step held; empty: it did not.
  const std::string& holdReason() const { return hold_reason_; }
  double margin() const { return wave_.margin(); }  ///< J
  double age() const { return age_; }               ///< s, since the hand's side was heard

 private:
  std::string holdReason(const Input& input) const;

  LinkConfig config_;
  WaveFollower wave_;
  LinkPacket heard_, outgoing_;
  std::uint64_t over_ = 0;  // the newest epoch that was let go
  double age_;              // s
  std::string hold_reason_;
};

}  // namespace microinjection
