#pragma once

#include <array>
#include <optional>
#include <string>

#include "operation/console/console_commands.h"
#include "operation/console/light.h"

namespace microinjection {

/// What the console starts with needle and camera, from top to bottom.
enum class CameraTask { kFocus, kCalibrate, kRezero, kUndo, kTouch, kMeasure };
constexpr std::array<CameraTask, 6> kCameraTasks = {CameraTask::kFocus, CameraTask::kCalibrate, CameraTask::kRezero,
                                                    CameraTask::kUndo,  CameraTask::kTouch,     CameraTask::kMeasure};
const char* toText(CameraTask task);
/// A service, which is over before a hand is at the button; the others are actions.
bool isService(CameraTask task);

/// What a task's button does now. The refusals are those that the console can know before; each node
/// has more of its own, which its result reports.
/// @param there    the node of the task answers
/// @param running  the task under way, of this console
CommandOffer offer(CameraTask task, const SessionView& session, bool there, std::optional<CameraTask> running);

/// The state of the last task, for people.
struct CameraTaskReport {
  enum class State { kNone, kRunning, kSucceeded, kFailed };
  State state = State::kNone;
  CameraTask task = CameraTask::kFocus;
  std::string text;  ///< progress or result
};
/// Yellow while it runs, green after success, red after a failure.
Lamp reportLamp(const CameraTaskReport& report);

}  // namespace microinjection
