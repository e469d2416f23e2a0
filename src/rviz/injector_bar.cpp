#include "rviz/injector_bar.h"

#include <std_srvs/Trigger.h>

#include <QGridLayout>
#include <QLabel>
#include <utility>

#include "rviz/session_parameters.h"

namespace microinjection {
namespace {

constexpr double kLargestPressure = 100e3;  // Pa, that can be entered; the node refuses what is beyond its range

std::string callReset(Bus& bus) {
  std_srvs::Trigger reset;
  if (!bus.call("/injector/reset", reset)) return "/injector/reset does not answer";
  return reset.response.success ? "" : reset.response.message;
}

}  // namespace

InjectorBar::InjectorBar(std::function<std::optional<InjectorView>()> newest, QWidget* parent)
    : QWidget(parent),
      newest_(std::move(newest)),
      pressure_(new NumberField(kLargestPressure, 0, this)),
      text_(new ElidedLabel(1, this)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->setColumnStretch(1, 1);
  layout->addWidget(new QLabel("Balance, Pa", this), 0, 0);
  pressure_->setToolTip("Gauge pressure between pulses");
  layout->addWidget(pressure_, 0, 1);
  int column = 2;
  for (const InjectorTask task : kInjectorTasks) {
    OfferButton*& button = buttons_[static_cast<std::size_t>(task)];
    button = new OfferButton(QString::fromStdString(offer(task, {}).label), this, [this, task] { press(task); });
    button->setFixedSize(56, 26);
    layout->addWidget(button, 0, column++);
  }
  layout->addWidget(text_, 1, 0, 1, column);
}

InjectorBar::~InjectorBar() = default;

void InjectorBar::start(const std::shared_ptr<Bus>& bus) {
  if (bus_) return;
  bus_ = bus;
  commands_ = bus->advertise<sensor_msgs::FluidPressure>("injector/set_balance", 1);
  setVisible(false);
}

InjectorTasksView InjectorBar::view(const std::optional<InjectorView>& injector) const {
  return {injector, commands_.subscribers() > 0, call_.running(), refusal_};
}

/// The parameter is that of the start: a pressure that was set since is in the state only, and a pulse's, too.
void InjectorBar::appear(const InjectorView& injector) {
  const auto balance = SessionParameters(*bus_, "/injector").number("balance");
  pressure_->setValue(balance.value_or(injector.busy ? 0 : injector.pressure));
  setVisible(true);
}

void InjectorBar::press(InjectorTask task) {
  if (!bus_) return;
  // The number that was typed, also without Enter.
  pressure_->clearFocus();
  if (!offer(task, view(newest_())).refusal.empty()) return;
  refusal_.clear();
  if (task == InjectorTask::kReset) return call_.start(bus_, callReset);
  sensor_msgs::FluidPressure message;
  message.header.stamp = bus_->now();
  message.fluid_pressure = pressure_->value();
  commands_.publish(message);
}

void InjectorBar::refresh(const std::optional<InjectorView>& injector) {
  if (!bus_) return;
  if (const auto refusal = call_.take()) refusal_ = *refusal;
  if (injector && isHidden()) appear(*injector);
  const InjectorTasksView shown = view(injector);
  for (const InjectorTask task : kInjectorTasks) {
    buttons_[static_cast<std::size_t>(task)]->offer(offer(task, shown).refusal.empty());
  }
  text_->setText(QString::fromStdString(injectorTasksText(shown)));
}

}  // namespace microinjection
