#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "operation/link/link_config.h"
#include "operation/link/link_packet.h"

namespace microinjection {

/// The rig's end of the link: computes the target of the needle from the hand's waves and the tip's
/// force. Each epoch begins at the needle's present position. The needle is held
/// - when the last packet of the hand's side is older than the time-out,
/// - when the hand's side holds,
/// - when needle, force or controller is invalid.
///
/// A hold ends the epoch.
class LinkFollower {
 public:
  struct Input {
    std::optional<Eigen::Vector3d> needle;  ///< m, tip in `world`
    std::optional<Eigen::Vector3d> force;   ///< N, of the cell on the tip, `world`
    bool controller = true;                 ///< the needle's controller is alive
  };

  explicit LinkFollower(const LinkConfig& config);

  void receive(const LinkPacket& packet);
  /// Advances by a period dt (s). Returns the target of the tip (m, `world`); empty: hold.
  std::optional<Eigen::Vector3d> step(const Input& input, double dt);
  LinkPacket packet();  ///< to send after each step
  /// Reason for the last step's hold; empty: it did not hold.
  const std::string& holdReason() const { return hold_reason_; }
  double margin() const { return wave_.margin(); }  ///< J
  double packetAge() const { return packet_age_; }  ///< s, since the hand's last packet

 private:
  std::string holdReason(const Input& input) const;

  LinkConfig config_;
  WaveFollower wave_;
  LinkPacket last_received_, outgoing_;
  std::uint64_t ended_epoch_ = 0;  // the newest epoch that ended
  double packet_age_;              // s
  std::string hold_reason_;
};

}  // namespace microinjection
