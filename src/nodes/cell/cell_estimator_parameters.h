#pragma once

#include <string>

#include "cell/estimation/cell_estimator.h"
#include "cell/estimation/cell_follower.h"
#include "cell/estimation/image_contact.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// config/cell_estimator.yaml, and what a session sets.
struct CellEstimatorParameters {
  std::string scene, families;
  double rate = 1000;
  double update_period = 0.02;
  double needle_timeout = 0.05, force_timeout = 0.05, controller_timeout = 0.5;
  double largest_tilt = 0.035;
  double largest_speed = 60e-6;
  double largest_force = 450e-6;
  double largest_sideways = 3e-6;
  double clear_distance = 5e-6;
  bool serve = true;
  CellFollowerConfig served;
  double puncture_deviation = 0.2;
  CellEstimatorConfig estimator;
  bool images = true;  ///< dimples in images are learned from
  ImageContactConfig image;

  /// @throws ConfigError
  static CellEstimatorParameters read(const Bus& bus);
};

}  // namespace microinjection
