#include "rviz/sensor_box.h"

#include <std_srvs/Trigger.h>

#include <QHBoxLayout>
#include <QLabel>

#include "base/parse_number.h"

namespace microinjection {
namespace {

using cell_microinjection::CalibrateForce;

constexpr double kLargestForce = 1000;  // uN, that can be entered; the node refuses what is beyond its range

std::string call(Bus& bus, SensorTask task, double along, double across) {
  if (task == SensorTask::kTare) {
    std_srvs::Trigger tare;
    if (!bus.call("/force_sensor/tare", tare)) return "/force_sensor/tare does not answer";
    return tare.response.success ? "" : tare.response.message;
  }
  CalibrateForce step;
  step.request.action = task == SensorTask::kPoint  ? CalibrateForce::Request::ADD
                        : task == SensorTask::kGain ? CalibrateForce::Request::SOLVE
                                                    : CalibrateForce::Request::UNDO;
  step.request.force.z = 1e-6 * along;
  step.request.force.x = 1e-6 * across;
  if (!bus.call("/force_sensor/calibrate", step)) return "/force_sensor/calibrate does not answer";
  return step.response.success ? "" : step.response.message;
}

}  // namespace

SensorBox::SensorBox(QWidget* parent)
    : QWidget(parent),
      diagnostics_("force_sensor: sensor", [this](const auto& status) { read(status); }),
      along_(new NumberField(kLargestForce, 1, this)),
      across_(new NumberField(kLargestForce, 1, this)),
      report_(new LampRow("", 2, this)) {
  QGridLayout* layout = boxLayout(this, "Force sensor");
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

void SensorBox::start(const std::shared_ptr<Bus>& bus) {
  bus_ = bus;
  diagnostics_.start(*bus);
}

void SensorBox::read(const diagnostic_msgs::DiagnosticStatus& status) {
  for (const auto& value : status.values) {
    if (value.key == "tare and calibration") sensor_.outcome = value.value;
    if (value.key == "calibration points") sensor_.points = parseNumber<int>(value.value).value_or(0);
  }
}

SensorView SensorBox::view() const {
  SensorView view = sensor_;
  view.there = diagnostics_.isFresh();
  view.called = call_.running();
  return view;
}

void SensorBox::press(SensorTask task) {
  if (!bus_ || !offer(task, view()).refusal.empty()) return;
  sensor_.refusal.clear();
  call_.start(bus_, [task, along = along_->value(), across = across_->value()](Bus& bus) {
    return call(bus, task, along, across);
  });
}

void SensorBox::refresh() {
  if (!bus_) return;
  if (const auto refusal = call_.take()) sensor_.refusal = *refusal;
  const SensorView shown = view();
  for (const SensorTask task : kSensorTasks) {
    rows_[static_cast<std::size_t>(task)].display(offer(task, shown));
  }
  report_->display(sensorLamp(shown));
}

}  // namespace microinjection
