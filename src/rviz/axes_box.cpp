#include "rviz/axes_box.h"

#include <QGridLayout>
#include <QLabel>
#include <thread>
#include <utility>

#include "rviz/session_clock.h"

namespace microinjection {
namespace {

using cell_microinjection::CalibrateAxes;

constexpr double kSilence = 3.5;  // s; the node reports each second

std::uint8_t actionOf(AxesTask task, bool running) {
  if (task == AxesTask::kUndo) return CalibrateAxes::Request::UNDO;
  if (task == AxesTask::kEnd) return CalibrateAxes::Request::STOP;
  return running ? CalibrateAxes::Request::MOTION : CalibrateAxes::Request::BEGIN;
}

}  // namespace

/// Filled by the thread that calls the service.
struct AxesBox::Answer {
  std::atomic<bool> done{false};
  bool came = false;
  CalibrateAxes::Response response;
};

AxesBox::AxesBox(QWidget* parent) : QWidget(parent), report_(new LampRow("", 2, this)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setHorizontalSpacing(8);
  layout->setVerticalSpacing(1);
  layout->setColumnStretch(1, 1);
  layout->addWidget(new QLabel("<b>Axes of the hand</b>", this), 0, 0, 1, 2);
  int line = 1;
  for (const AxesTask task : kAxesTasks) {
    rows_.emplace_back(QString::fromStdString(offer(task, {}).label), 1, this, layout, line++,
                       [this, task] { press(task); });
  }
  layout->addWidget(report_, line, 0, 1, 2);
}

AxesBox::~AxesBox() = default;

void AxesBox::start() {
  if (node_) return;
  node_.emplace();
  node_->setCallbackQueue(&queue_);
  // Each node reports by itself, within the same millisecond as others.
  reports_ = node_->subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 50,
      boost::function<void(const diagnostic_msgs::DiagnosticArray::ConstPtr&)>(
          [this](const auto& message) { onDiagnostics(*message); }));
}

void AxesBox::onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
  for (const auto& status : message.status) {
    if (status.name == "haptic_bridge: loop") heard_at_ = sessionNow();
  }
}

AxesView AxesBox::view() const {
  AxesView view = axes_;
  view.there = heard_at_ && sessionNow() - *heard_at_ < kSilence;
  view.called = answer_ != nullptr;
  return view;
}

void AxesBox::press(AxesTask task) {
  if (!node_ || !offer(task, view()).refusal.empty()) return;
  axes_.refusal.clear();
  answer_ = std::make_shared<Answer>();
  std::thread([answer = answer_, action = actionOf(task, !axes_.next.empty())] {
    CalibrateAxes step;
    step.request.action = action;
    answer->came = ros::service::call("/haptic_bridge/calibrate_axes", step);
    answer->response = step.response;
    answer->done = true;
  }).detach();
}

void AxesBox::take(const Answer& answer) {
  if (!answer.came) {
    axes_.refusal = "/haptic_bridge/calibrate_axes does not answer";
    return;
  }
  axes_.answered = true;
  axes_.next = answer.response.next;
  axes_.axes = answer.response.device_axes;
  axes_.angle_to_axis = answer.response.angle_to_axis;
  axes_.angle_to_square = answer.response.angle_to_square;
  if (!answer.response.success) axes_.refusal = answer.response.message;
}

void AxesBox::refresh() {
  if (!node_) return;
  queue_.callAvailable(ros::WallDuration(0));
  if (answer_ && answer_->done) take(*std::exchange(answer_, nullptr));
  const AxesView shown = view();
  for (const AxesTask task : kAxesTasks) {
    const CommandOffer offered = offer(task, shown);
    rows_[static_cast<std::size_t>(task)].display(offered.refusal.empty(),
                                                  offered.refusal.empty() ? offered.effect : offered.refusal);
  }
  report_->display(axesLamp(shown));
}

}  // namespace microinjection
