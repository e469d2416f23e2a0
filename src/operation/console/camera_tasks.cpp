#include "operation/console/camera_tasks.h"

#include "operation/console/pixel_goal.h"

namespace microinjection {
namespace {

/// A task, and the node that does it.
struct DescribedCameraTask {
  const char *name, *node, *effect;
};
/// In the order of CameraTask.
constexpr DescribedCameraTask kDescribedCameraTasks[] = {
    {"Focus", "focus", "moves the focus until the tip is sharp"},
    {"Calibrate", "calibration", "moves the needle over a pattern above its place: pixel size, angle, backlash"},
    {"Re-zero", "calibration", "after a pipette change: the tip's new place, with the same axes"},
    {"Undo", "calibration", "the calibration before this session's last Calibrate or Re-zero"},
    {"Touch", "touch", "lowers the needle until the image shows that it touches the cell"},
    {"Measure", "vision", "measures the cell in the image, and has it served"}};

const DescribedCameraTask& describe(CameraTask task) { return kDescribedCameraTasks[static_cast<std::size_t>(task)]; }

std::string refusalOf(CameraTask task, const SessionView& session) {
  const bool disabled = !session.operating || session.operating == OperatingState::kDisabled;
  if (task == CameraTask::kCalibrate && !disabled) {
    return std::string("the controller is ") + toText(*session.operating) + ": press Disable first";
  }
  return task == CameraTask::kTouch ? refusalOfLeading(session) : "";
}

}  // namespace

const char* toText(CameraTask task) { return describe(task).name; }

bool isService(CameraTask task) {
  return task == CameraTask::kRezero || task == CameraTask::kUndo || task == CameraTask::kMeasure;
}

CommandOffer offer(CameraTask task, const SessionView& session, bool there, std::optional<CameraTask> running) {
  CommandOffer result{describe(task).name, "", describe(task).effect, ""};
  if (!there) {
    result.refusal = std::string("no node ") + describe(task).node + ": start the session with camera:=";
  } else if (running) {
    result.refusal = std::string(toText(*running)) + " is under way";
  } else {
    result.refusal = refusalOf(task, session);
  }
  return result;
}

Lamp reportLamp(const CameraTaskReport& report) {
  using State = CameraTaskReport::State;
  if (report.state == State::kNone) return {Light::kGrey, "nothing was started"};
  const Light light = report.state == State::kRunning     ? Light::kYellow
                      : report.state == State::kSucceeded ? Light::kGreen
                                                          : Light::kRed;
  return {light, std::string(toText(report.task)) + ": " + report.text};
}

}  // namespace microinjection
