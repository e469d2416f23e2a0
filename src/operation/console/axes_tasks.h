#pragma once

#include <array>
#include <string>

#include "operation/console/console_commands.h"
#include "operation/console/light.h"

namespace microinjection {

/// The buttons of a calibration of the haptic device's axes, from top to bottom.
enum class AxesTask { kStep, kUndo, kEnd };
constexpr std::array<AxesTask, 3> kAxesTasks = {AxesTask::kStep, AxesTask::kUndo, AxesTask::kEnd};

/// What the console knows of that calibration: the last answer of /haptic_bridge/calibrate_axes.
struct AxesView {
  bool there = false;          ///< the node reports
  bool called = false;         ///< the service was called, and has not answered
  bool answered = false;       ///< it has answered once
  std::string next;            ///< right, away or up; empty: no run
  std::string axes;            ///< device_axes
  double angle_to_axis = 0;    ///< rad
  double angle_to_square = 0;  ///< rad
  std::string refusal;         ///< of the last step; empty: it was not refused
};

/// What a button does now, or why it is greyed. The node has refusals of its own, which axesLamp() shows.
CommandOffer offer(AxesTask task, const AxesView& axes);
/// Yellow while a run holds the needle, red after a refusal, else green with the axes; both with the residual.
Lamp axesLamp(const AxesView& axes);

}  // namespace microinjection
