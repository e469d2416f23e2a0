#include "operation/console/camera_tasks.h"

#include "operation/console/pixel_goal.h"

namespace microinjection {
namespace {

CommandOffer describe(CameraTask task) {
  switch (task) {
    case CameraTask::kFocus:
      return {"Focus", "", "moves the focus until the tip is sharp", ""};
    case CameraTask::kCalibrate:
      return {"Calibrate", "", "moves the needle over a pattern above its place: pixel size, angle, backlash", ""};
    case CameraTask::kRezero:
      return {"Re-zero", "", "after a pipette change: the tip's new place, with the same axes", ""};
    case CameraTask::kUndo:
      return {"Undo", "", "the calibration before this session's last Calibrate or Re-zero", ""};
    case CameraTask::kTouch:
      return {"Touch", "", "lowers the needle until the image shows that it touches the cell", ""};
    case CameraTask::kMeasure:
      break;
  }
  return {"Measure", "", "measures the cell in the image, and has it served", ""};
}

const char* nodeOf(CameraTask task) {
  if (task == CameraTask::kFocus) return "focus";
  if (task == CameraTask::kMeasure) return "vision";
  return task == CameraTask::kTouch ? "touch" : "calibration";
}

std::string refusalOf(CameraTask task, const SessionView& session) {
  const bool disabled = !session.operating || session.operating == OperatingState::kDisabled;
  if (task == CameraTask::kCalibrate && !disabled) {
    return std::string("the controller is ") + toText(*session.operating) + ": press Disable first";
  }
  return task == CameraTask::kTouch ? refusalOfLeading(session) : "";
}

}  // namespace

const char* toText(CameraTask task) {
  constexpr const char* kNames[] = {"Focus", "Calibrate", "Re-zero", "Undo", "Touch", "Measure"};
  return kNames[static_cast<std::size_t>(task)];
}

bool isService(CameraTask task) {
  return task == CameraTask::kRezero || task == CameraTask::kUndo || task == CameraTask::kMeasure;
}

CommandOffer offer(CameraTask task, const SessionView& session, bool there, std::optional<CameraTask> running) {
  CommandOffer result = describe(task);
  if (!there) {
    result.refusal = std::string("no node ") + nodeOf(task) + ": start the session with camera:=";
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
