#include "rviz/camera_task_runners.h"

#include <cell_microinjection/CalibrateAction.h>
#include <cell_microinjection/FindFocusAction.h>
#include <cell_microinjection/FindTouchAction.h>
#include <cell_microinjection/MeasureCell.h>
#include <cell_microinjection/VisionState.h>
#include <std_srvs/Trigger.h>

#include "operation/console/figures.h"
#include "rviz/session_clock.h"

namespace microinjection {
namespace {

using cell_microinjection::CalibrateAction;
using cell_microinjection::CalibrateFeedback;
using cell_microinjection::FindFocusAction;
using cell_microinjection::FindFocusFeedback;
using cell_microinjection::FindTouchAction;
using cell_microinjection::FindTouchFeedback;

std::string of(int number, int all) { return std::to_string(number) + " of " + std::to_string(all); }

template <typename Service>
std::pair<bool, std::string> outcomeOfCall(Bus& bus, const std::string& name, Service service = {}) {
  if (!bus.call(name, service)) return {false, name + " does not answer"};
  return {service.response.success, service.response.message};
}

std::size_t indexOf(CameraTask task) { return static_cast<std::size_t>(task); }

}  // namespace

CameraTaskRunners::CameraTaskRunners(const std::shared_ptr<Bus>& bus) : bus_(bus) {
  // Nobody reads it here: its publisher is the node that measures.
  vision_ = bus->subscribe<cell_microinjection::VisionState>("vision/state", 1, [](const auto&) {});
  const auto add = [this](CameraTask task, const auto& make) {
    runners_[indexOf(task)] =
        make([this, task](const std::string& text) { progress(task, text); },
             [this, task](bool success, const std::string& message) { end(task, success, message); });
  };
  add(CameraTask::kFocus, [this](auto progress, auto end) {
    return std::make_unique<ActionRunner<FindFocusAction>>(
        *bus_, "focus/find", [](const FindFocusFeedback& at) { return "plane " + of(at.plane, at.planes); }, progress,
        end);
  });
  add(CameraTask::kCalibrate, [this](auto progress, auto end) {
    return std::make_unique<ActionRunner<CalibrateAction>>(
        *bus_, "calibration/calibrate",
        [](const CalibrateFeedback& at) {
          return "point " + of(at.waypoint, at.waypoints) + ", tip seen at " + std::to_string(at.seen);
        },
        progress, end);
  });
  add(CameraTask::kTouch, [this](auto progress, auto end) {
    return std::make_unique<ActionRunner<FindTouchAction>>(
        *bus_, "touch/find",
        [](const FindTouchFeedback& at) {
          return micro(at.travel, 1) + " um down, outline displaced by " + figure(at.displacement, 1, 1) + " px";
        },
        progress, end);
  });
}

CameraTaskRunners::~CameraTaskRunners() = default;

void CameraTaskRunners::poll() {
  serveArrived(*bus_);
  if (const auto answer = call_.take()) end(report_.task, answer->first, answer->second);
}

bool CameraTaskRunners::there(CameraTask task) const {
  if (task == CameraTask::kMeasure) return vision_.publishers() > 0;
  // The other services are of the node that calibrates.
  return runners_[indexOf(isService(task) ? CameraTask::kCalibrate : task)]->there();
}

std::optional<CameraTask> CameraTaskRunners::running() const {
  return report_.state == CameraTaskReport::State::kRunning ? std::optional(report_.task) : std::nullopt;
}

void CameraTaskRunners::start(CameraTask task) {
  report_ = {CameraTaskReport::State::kRunning, task, "begins"};
  if (isService(task)) {
    call(task);
  } else {
    runners_[indexOf(task)]->start();
  }
}

void CameraTaskRunners::call(CameraTask task) {
  call_.start(bus_, [task](Bus& bus) {
    if (task != CameraTask::kMeasure) {
      const bool again = task == CameraTask::kRezero;
      return outcomeOfCall<std_srvs::Trigger>(bus, again ? "/calibration/rezero" : "/calibration/undo");
    }
    cell_microinjection::MeasureCell measurement;
    measurement.request.serve = true;
    return outcomeOfCall(bus, "/vision/measure_cell", measurement);
  });
}

void CameraTaskRunners::cancel() {
  for (const auto& runner : runners_) {
    if (runner) runner->cancel();
  }
}

void CameraTaskRunners::progress(CameraTask task, const std::string& text) {
  if (running() == task) report_.text = text;
}

void CameraTaskRunners::end(CameraTask task, bool success, const std::string& message) {
  using State = CameraTaskReport::State;
  report_ = {success ? State::kSucceeded : State::kFailed, task, message};
}

}  // namespace microinjection
