#include "rviz/camera_task_runners.h"

#include <cell_microinjection/CalibrateAction.h>
#include <cell_microinjection/FindFocusAction.h>
#include <cell_microinjection/FindTouchAction.h>
#include <cell_microinjection/MeasureCell.h>
#include <cell_microinjection/VisionState.h>
#include <std_srvs/Trigger.h>

#include <thread>

#include "operation/console/figures.h"

namespace microinjection {
namespace {

using cell_microinjection::CalibrateAction;
using cell_microinjection::CalibrateFeedback;
using cell_microinjection::CalibrateGoal;
using cell_microinjection::CalibrateResult;
using cell_microinjection::FindFocusAction;
using cell_microinjection::FindFocusFeedback;
using cell_microinjection::FindFocusGoal;
using cell_microinjection::FindFocusResult;
using cell_microinjection::FindTouchAction;
using cell_microinjection::FindTouchFeedback;
using cell_microinjection::FindTouchGoal;
using cell_microinjection::FindTouchResult;

std::string of(int number, int all) { return std::to_string(number) + " of " + std::to_string(all); }

std::size_t indexOf(CameraTask task) { return static_cast<std::size_t>(task); }

}  // namespace

/// Filled by the thread that calls the service. It is shared with that thread: a call to a node that
/// hangs may outlive the panel.
struct CameraTaskRunners::ServiceAnswer {
  std::atomic<bool> done{false};
  bool success = false;
  std::string message;
};

template <typename Service>
void CameraTaskRunners::call(const std::string& name, Service& service, ServiceAnswer& answer) {
  const bool answered = ros::service::call(name, service);
  answer.success = answered && service.response.success;
  answer.message = answered ? service.response.message : name + " does not answer";
}

CameraTaskRunners::CameraTaskRunners() {
  node_.setCallbackQueue(&queue_);
  // Nobody reads it here: its publisher is the node that measures.
  vision_ = node_.subscribe<cell_microinjection::VisionState>(
      "vision/state", 1, boost::function<void(const cell_microinjection::VisionState::ConstPtr&)>([](const auto&) {}));
  const auto add = [this](CameraTask task, const auto& make) {
    runners_[indexOf(task)] =
        make([this, task](const std::string& text) { progress(task, text); },
             [this, task](bool success, const std::string& message) { end(task, success, message); });
  };
  add(CameraTask::kFocus, [this](auto progress, auto end) {
    return std::make_unique<ActionRunner<FindFocusAction, FindFocusGoal, FindFocusFeedback, FindFocusResult>>(
        node_, "focus/find", [](const FindFocusFeedback& at) { return "plane " + of(at.plane, at.planes); }, progress,
        end);
  });
  add(CameraTask::kCalibrate, [this](auto progress, auto end) {
    return std::make_unique<ActionRunner<CalibrateAction, CalibrateGoal, CalibrateFeedback, CalibrateResult>>(
        node_, "calibration/calibrate",
        [](const CalibrateFeedback& at) {
          return "point " + of(at.waypoint, at.waypoints) + ", tip seen at " + std::to_string(at.seen);
        },
        progress, end);
  });
  add(CameraTask::kTouch, [this](auto progress, auto end) {
    return std::make_unique<ActionRunner<FindTouchAction, FindTouchGoal, FindTouchFeedback, FindTouchResult>>(
        node_, "touch/find",
        [](const FindTouchFeedback& at) {
          return micro(at.travel, 1) + " um down, outline displaced by " + figure(at.displacement, 1, 1) + " px";
        },
        progress, end);
  });
}

CameraTaskRunners::~CameraTaskRunners() = default;

void CameraTaskRunners::poll() {
  queue_.callAvailable(ros::WallDuration(0));
  if (!answer_ || !answer_->done) return;
  const auto answer = std::move(answer_);
  end(report_.task, answer->success, answer->message);
}

bool CameraTaskRunners::there(CameraTask task) const {
  if (task == CameraTask::kMeasure) return vision_.getNumPublishers() > 0;
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
  answer_ = std::make_shared<ServiceAnswer>();
  std::thread([answer = answer_, task] {
    if (task == CameraTask::kMeasure) {
      cell_microinjection::MeasureCell measurement;
      measurement.request.serve = true;
      call("/vision/measure_cell", measurement, *answer);
    } else {
      std_srvs::Trigger trigger;
      call(task == CameraTask::kRezero ? "/calibration/rezero" : "/calibration/undo", trigger, *answer);
    }
    answer->done = true;
  }).detach();
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
