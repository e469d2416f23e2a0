#include "rviz/injector_bar.h"

#include <sensor_msgs/FluidPressure.h>
#include <std_srvs/Trigger.h>

#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>

#include "rviz/session_parameters.h"

namespace microinjection {
namespace {

constexpr double kLargest = 1e6;  // Pa, that can be entered; the node refuses what is beyond its range

}  // namespace

InjectorBar::InjectorBar(QWidget* parent) : QWidget(parent), pressure_(new QDoubleSpinBox(this)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(new QLabel("Balance, Pa", this));
  pressure_->setRange(-kLargest, kLargest);
  pressure_->setDecimals(0);
  pressure_->setToolTip("Gauge pressure between pulses");
  // A field that keeps the focus would keep the space bar from STOP.
  pressure_->setFocusPolicy(Qt::ClickFocus);
  QObject::connect(pressure_, &QDoubleSpinBox::editingFinished, pressure_, &QWidget::clearFocus);
  layout->addWidget(pressure_, 1);
  set_ = new OfferButton("Set", this, [this] { setBalance(); });
  reset_ = new OfferButton("Reset", this, [this] { reset(); });
  reset_->setToolTip("Clears the injector's fault and its volume");
  for (OfferButton* button : {set_, reset_}) {
    button->setFixedSize(56, 26);
    layout->addWidget(button);
  }
}

InjectorBar::~InjectorBar() = default;

void InjectorBar::start() {
  if (node_) return;
  node_.emplace();
  commands_ = node_->advertise<sensor_msgs::FluidPressure>("injector/set_balance", 1);
  setVisible(false);
}

void InjectorBar::setBalance() {
  if (!node_ || !there_) return;
  sensor_msgs::FluidPressure message;
  message.header.stamp = ros::Time::now();
  message.fluid_pressure = pressure_->value();
  commands_.publish(message);
}

void InjectorBar::reset() {
  if (!node_ || !there_ || call_.running()) return;
  call_.start([]() -> std::string {
    std_srvs::Trigger reset;
    return ros::service::call("/injector/reset", reset) ? reset.response.message : "/injector/reset does not answer";
  });
}

void InjectorBar::refresh(const std::optional<InjectorView>& injector) {
  if (!node_) return;
  call_.take();  // a fault that stays is in the injector's state, and its lamp shows it
  const bool was_there = std::exchange(there_, injector.has_value());
  if (there_ && !was_there) {
    if (const auto balance = SessionParameters("/injector").number("balance")) pressure_->setValue(*balance);
    setVisible(true);
  }
  set_->offer(there_ && commands_.getNumSubscribers() > 0);
  reset_->offer(there_ && !call_.running());
}

}  // namespace microinjection
