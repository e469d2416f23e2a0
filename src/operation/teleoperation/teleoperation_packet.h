#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace microinjection {

/// What crosses the channel between the operator's machine and the rig's, either way.
struct TeleoperationPacket {
  std::uint64_t sequence = 0;  ///< counts up from 1, one a period; late and repeated ones are known by it
  std::uint64_t echo = 0;      ///< the newest sequence that the sender has heard, from which the round trip is known
  /// Integral of the wave (sqrt(W) s), at the hand's scale.
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  double energy = 0;  ///< J, all that has entered the channel at the sender's side since the start
};

}  // namespace microinjection
