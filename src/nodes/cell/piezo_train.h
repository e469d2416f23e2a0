#pragma once

#include <cell_microinjection/PiezoPulses.h>

#include <optional>

#include "cell/model/piezo_stroke.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// The pulses that a piezo-driven needle is told to give, one after the other.
///
/// In: /needle/piezo_pulses (PiezoPulses). Another one takes the place of that under way; one with a number of 0 ends
/// it, whatever its stamp.
class PiezoTrain {
 public:
  static constexpr double kLargestAmplitude = 20e-6;                      ///< m
  static constexpr double kShortestRise = 1e-6, kLongestRise = 0.5e-3;    ///< s
  static constexpr double kSlowest = 0.1, kFastest = 1000, kMost = 1000;  ///< 1/s, 1/s, pulses

  explicit PiezoTrain(Bus& bus);
  /// The pulse of this step, if one is due. Two that are due in one step are one: they are alike.
  std::optional<PiezoPulse> due(const ros::Time& now);

 private:
  void receive(const cell_microinjection::PiezoPulses& message);

  Bus& bus_;
  PiezoPulse pulse_;
  double period_ = 0;       ///< s
  std::uint32_t left_ = 0;  ///< pulses
  ros::Time next_;
  Subscription subscription_;
};

}  // namespace microinjection
