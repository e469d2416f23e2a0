#pragma once

#include <string>

#include "operation/link/wave_port.h"

namespace microinjection {

/// The network link between bridge and rig.
struct LinkConfig {
  std::string scheme = "none";  ///< none: no network; wave: wave variables between bridge and rig
  double timeout = 0.3;         ///< s without a packet until the rig holds the needle and the hand's force is zero
  WaveConfig wave;

  bool used() const { return scheme != "none"; }
  static LinkConfig read(ConfigReader reader);
};

}  // namespace microinjection
