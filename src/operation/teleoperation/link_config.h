#pragma once

#include <string>

#include "operation/teleoperation/wave_port.h"

namespace microinjection {

/// A network between bridge and rig.
struct LinkConfig {
  std::string scheme = "none";  ///< none: bridge and rig are one; wave: wave variables between them
  double timeout = 0.3;         ///< s without a packet: the rig holds the needle, the hand feels nothing
  WaveConfig wave;

  bool used() const { return scheme != "none"; }
  static LinkConfig read(ConfigReader reader);
};

}  // namespace microinjection
