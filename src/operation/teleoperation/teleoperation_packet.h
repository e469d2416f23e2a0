#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace microinjection {

/// Packet of the channel between the operator's machine and the rig's, in either direction.
struct TeleoperationPacket {
  std::uint64_t sequence = 0;  ///< counts periods from 1; identifies late and repeated packets
  std::uint64_t echo = 0;      ///< the newest sequence that the sender has received; gives the round-trip time
  /// Integral of the wave (sqrt(W) s), at the hand's scale.
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  double energy = 0;  ///< J, total energy that entered the channel at the sender's side
};

}  // namespace microinjection
