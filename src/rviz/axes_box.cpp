#include "rviz/axes_box.h"

namespace microinjection {
namespace {

using cell_microinjection::CalibrateAxes;

std::uint8_t actionOf(AxesTask task, bool running) {
  if (task == AxesTask::kUndo) return CalibrateAxes::Request::UNDO;
  if (task == AxesTask::kEnd) return CalibrateAxes::Request::STOP;
  return running ? CalibrateAxes::Request::MOTION : CalibrateAxes::Request::BEGIN;
}

}  // namespace

AxesBox::AxesBox(QWidget* parent) : QWidget(parent), report_(new LampRow("", 2, this)) {
  QGridLayout* layout = boxLayout(this, "Axes of the hand");
  int line = 1;
  for (const AxesTask task : kAxesTasks) {
    rows_.emplace_back(QString::fromStdString(offer(task, {}).label), 1, this, layout, line++,
                       [this, task] { press(task); });
  }
  layout->addWidget(report_, line, 0, 1, 2);
}

AxesBox::~AxesBox() = default;

void AxesBox::start(const std::shared_ptr<Bus>& bus) {
  bus_ = bus;
  diagnostics_.start(*bus);
}

AxesView AxesBox::view() const {
  AxesView view = axes_;
  view.there = diagnostics_.isFresh();
  view.called = call_.running();
  return view;
}

void AxesBox::press(AxesTask task) {
  if (!bus_ || !offer(task, view()).refusal.empty()) return;
  axes_.refusal.clear();
  call_.start(bus_, [action = actionOf(task, !axes_.next.empty())](Bus& bus) {
    CalibrateAxes step;
    step.request.action = action;
    const bool came = bus.call("/haptic_bridge/calibrate_axes", step);
    return Answer{came, step.response};
  });
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
  if (!bus_) return;
  if (const auto answer = call_.take()) take(*answer);
  const AxesView shown = view();
  for (const AxesTask task : kAxesTasks) {
    rows_[static_cast<std::size_t>(task)].display(offer(task, shown));
  }
  report_->display(axesLamp(shown));
}

}  // namespace microinjection
