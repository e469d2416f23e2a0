#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "operation/teleoperation/teleoperation_packet.h"

namespace microinjection {

/// What hand and rig tell each other, each in every period.
struct LinkPacket {
  std::uint64_t number = 0;   ///< counts up over all epochs of a sender
  std::uint64_t epoch = 0;    ///< names the time from one taking up of the hand to the next hold; 0: none. The hand's
                              ///< side begins it, the rig's repeats it
  bool follows = false;       ///< hand: the needle shall follow; rig: it does
  TeleoperationPacket wave;   ///< of the epoch
  double position_scale = 0;  ///< 1, hand's side: metres of needle per metre of hand
  double force_gain = 0;      ///< 1, hand's side: newtons at the hand per newton at the tip
  bool valid = false;         ///< rig's side: it knows needle and force
  Eigen::Vector3d needle = Eigen::Vector3d::Zero();  ///< m, rig's side: the tip in `world`
};

}  // namespace microinjection
