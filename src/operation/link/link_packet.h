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

/// Message between hand and rig; each sends one in every period.
struct LinkPacket {
  std::uint64_t number = 0;   ///< counts up over all epochs of a sender
  std::uint64_t epoch = 0;    ///< number of the time from an engagement to the next hold; 0: none. The hand's
                              ///< side sets it, the rig's repeats it
  bool follows = false;       ///< from the hand: the needle shall follow; from the rig: it follows
  TeleoperationPacket wave;   ///< of the epoch
  double position_scale = 0;  ///< 1, hand's side: metres of needle per metre of hand
  double force_gain = 0;      ///< 1, hand's side: newtons at the hand per newton at the tip
  bool valid = false;         ///< rig's side: needle and force are valid
  Eigen::Vector3d needle = Eigen::Vector3d::Zero();  ///< m, rig's side: the tip in `world`
};

}  // namespace microinjection
