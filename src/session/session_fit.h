#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "session/session.h"

namespace microinjection {

/// The parameters that follow the cell. The files of config and the URDF are for a cell of 56 um and 17.9 kPa. For
/// another one lengths and speeds are scaled with its radius R, forces with E R^2 (E: the Young's modulus that the
/// needle feels), and the guards of the force with the largest puncture force. The overrides of the session have the
/// last word.
struct SessionFit {
  YAML::Node parameters;          ///< {NODE: {KEY: VALUE}}, those that differ from the files, and the overrides
  std::string robot_description;  ///< URDF
  std::string text;               ///< one line for the user

  /// `device`: the file of the hand's device, an empty map without one. Throws ConfigError with a line for everything
  /// that does not go together.
  static SessionFit of(const Session& session, const YAML::Node& device);
};

}  // namespace microinjection
