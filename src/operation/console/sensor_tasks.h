#pragma once

#include <array>
#include <string>

#include "operation/console/console_commands.h"
#include "operation/console/light.h"

namespace microinjection {

/// The steps of a calibration of the force sensor, from top to bottom.
enum class SensorTask { kTare, kPoint, kGain, kUndo };
constexpr std::array<SensorTask, 4> kSensorTasks = {SensorTask::kTare, SensorTask::kPoint, SensorTask::kGain,
                                                    SensorTask::kUndo};

/// What the console knows of the force sensor's calibration.
struct SensorView {
  bool there = false;   ///< the node reports
  bool called = false;  ///< a service of it was called, and has not answered
  std::string outcome;  ///< of the last average or gain, from /diagnostics
  int points = 0;       ///< known forces that the next gain takes
  std::string refusal;  ///< of the last step; empty: it was not refused
  bool averaging() const;
  bool aborted() const;  ///< the last average
};

/// What a step's button does now, or why it is greyed. The node has refusals of its own, which sensorLamp() shows.
CommandOffer offer(SensorTask task, const SensorView& sensor);
/// Yellow while an average is under way, red after a refusal, else green with the residual of the last step.
Lamp sensorLamp(const SensorView& sensor);

}  // namespace microinjection
