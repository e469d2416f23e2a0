#include "rviz/sensor_box.h"

#include <std_srvs/Trigger.h>

#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <thread>
#include <utility>

#include "base/parse_number.h"
#include "rviz/session_clock.h"

namespace microinjection {
namespace {

using cell_microinjection::CalibrateForce;

constexpr double kSilence = 3.5;   // s; the node reports each second
constexpr double kLargest = 1000;  // uN, that can be entered; the node refuses what is beyond its range

QDoubleSpinBox* forceField(QWidget* parent) {
  auto* field = new QDoubleSpinBox(parent);
  field->setRange(-kLargest, kLargest);
  field->setDecimals(1);
  // A field that keeps the focus would keep the space bar from STOP.
  field->setFocusPolicy(Qt::ClickFocus);
  QObject::connect(field, &QDoubleSpinBox::editingFinished, field, &QWidget::clearFocus);
  return field;
}

std::string call(SensorTask task, double along, double across) {
  if (task == SensorTask::kTare) {
    std_srvs::Trigger tare;
    if (!ros::service::call("/force_sensor/tare", tare)) return "/force_sensor/tare does not answer";
    return tare.response.success ? "" : tare.response.message;
  }
  CalibrateForce step;
  step.request.action = task == SensorTask::kPoint  ? CalibrateForce::Request::ADD
                        : task == SensorTask::kGain ? CalibrateForce::Request::SOLVE
                                                    : CalibrateForce::Request::UNDO;
  step.request.force.z = 1e-6 * along;
  step.request.force.x = 1e-6 * across;
  if (!ros::service::call("/force_sensor/calibrate", step)) return "/force_sensor/calibrate does not answer";
  return step.response.success ? "" : step.response.message;
}

}  // namespace

/// Filled by the thread that calls the service.
struct SensorBox::Answer {
  std::atomic<bool> done{false};
  std::string refusal;
};

SensorBox::SensorBox(QWidget* parent)
    : QWidget(parent), along_(forceField(this)), across_(forceField(this)), report_(new LampRow("", 2, this)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setHorizontalSpacing(8);
  layout->setVerticalSpacing(1);
  layout->setColumnStretch(1, 1);
  layout->addWidget(new QLabel("<b>Force sensor</b>", this), 0, 0, 1, 2);
  int line = 1;
  for (const SensorTask task : kSensorTasks) {
    rows_.emplace_back(QString::fromStdString(offer(task, {}).label), 1, this, layout, line++,
                       [this, task] { press(task); });
  }
  auto* forces = new QHBoxLayout;
  forces->addWidget(new QLabel("uN along", this));
  forces->addWidget(along_, 1);
  forces->addWidget(new QLabel("across", this));
  forces->addWidget(across_, 1);
  layout->addLayout(forces, line++, 0, 1, 2);
  layout->addWidget(report_, line, 0, 1, 2);
}

SensorBox::~SensorBox() = default;

void SensorBox::start() {
  if (node_) return;
  node_.emplace();
  node_->setCallbackQueue(&queue_);
  // Each node reports by itself, within the same millisecond as others.
  reports_ = node_->subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 50,
      boost::function<void(const diagnostic_msgs::DiagnosticArray::ConstPtr&)>(
          [this](const auto& message) { onDiagnostics(*message); }));
}

void SensorBox::onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
  for (const auto& status : message.status) {
    if (status.name != "force_sensor: sensor") continue;
    heard_at_ = sessionNow();
    for (const auto& value : status.values) {
      if (value.key == "tare and calibration") sensor_.outcome = value.value;
      if (value.key == "calibration points") sensor_.points = parseNumber<int>(value.value).value_or(0);
    }
  }
}

SensorView SensorBox::view() const {
  SensorView view = sensor_;
  view.there = heard_at_ && sessionNow() - *heard_at_ < kSilence;
  view.called = answer_ != nullptr;
  return view;
}

void SensorBox::press(SensorTask task) {
  if (!node_ || !offer(task, view()).refusal.empty()) return;
  sensor_.refusal.clear();
  answer_ = std::make_shared<Answer>();
  std::thread([answer = answer_, task, along = along_->value(), across = across_->value()] {
    answer->refusal = call(task, along, across);
    answer->done = true;
  }).detach();
}

void SensorBox::refresh() {
  if (!node_) return;
  queue_.callAvailable(ros::WallDuration(0));
  if (answer_ && answer_->done) sensor_.refusal = std::exchange(answer_, nullptr)->refusal;
  const SensorView shown = view();
  for (const SensorTask task : kSensorTasks) {
    const CommandOffer offered = offer(task, shown);
    rows_[static_cast<std::size_t>(task)].display(offered.refusal.empty(),
                                                  offered.refusal.empty() ? offered.effect : offered.refusal);
  }
  report_->display(sensorLamp(shown));
}

}  // namespace microinjection
