#include "rviz/focus_bar.h"

#include <QHBoxLayout>
#include <cmath>
#include <vector>

#include "rviz/session_clock.h"
#include "rviz/session_parameters.h"

namespace microinjection {
namespace {

constexpr double kMotorSilence = 1;  // s, of a motor that has reported
constexpr double kOnItsWay = 1;      // s after a step; then the place that the motor reports counts again

}  // namespace

FocusBar::FocusBar(QWidget* parent)
    : QWidget(parent),
      row_(new JogRow(
          "Focus", {"-", "+"}, {0.5e-6, 1e-6, 5e-6, 20e-6}, [this](std::size_t button) { move(button == 0 ? -1 : 1); },
          this)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(6, 0, 6, 2);
  layout->addWidget(row_);
  setVisible(false);
}

FocusBar::~FocusBar() = default;

void FocusBar::start(Bus& bus) {
  if (bus_) return;
  bus_ = &bus;
  commands_ = bus.advertise<sensor_msgs::JointState>("focus/move_jp", 1);
  search_ = std::make_unique<ActionWatch>(bus, "focus/find");
  positions_ = bus.subscribe<sensor_msgs::JointState>("focus/measured_js", 1,
                                                      [this](const auto& delivery) { onPosition(*delivery.message); });
}

void FocusBar::onPosition(const sensor_msgs::JointState& message) {
  if (message.position.empty() || !std::isfinite(message.position[0])) return;
  // The range is set before the virtual microscope starts; other motors have none that is known here.
  if (!focus_.position || sessionNow(*bus_) - heard_at_ > kMotorSilence) {
    const std::vector<double> range = SessionParameters(*bus_, "/microscope").numbers("focus/range");
    const FocusView unlimited;
    focus_.lowest = range.size() == 2 ? range[0] : unlimited.lowest;
    focus_.highest = range.size() == 2 ? range[1] : unlimited.highest;
  }
  focus_.position = message.position[0];
  heard_at_ = sessionNow(*bus_);
  setVisible(true);
}

FocusView FocusBar::view() const {
  FocusView view = focus_;
  if (sessionNow(*bus_) - heard_at_ > kMotorSilence) view.position.reset();
  if (sessionNow(*bus_) - sent_at_ > kOnItsWay) view.goal.reset();
  view.searched = search_ && search_->active();
  return view;
}

void FocusBar::move(int steps) {
  if (!bus_) return;
  serveArrived(*bus_);
  const FocusView focus = view();
  const double step = steps * row_->step();
  if (!offerFocusStep(focus, step).refusal.empty()) return;
  focus_.goal = focusGoal(focus, step);
  sent_at_ = sessionNow(*bus_);
  sensor_msgs::JointState message;
  message.header.stamp = bus_->now();
  message.name = {"focus"};
  message.position = {*focus_.goal};
  commands_.publish(message);
}

void FocusBar::refresh() {
  if (!bus_) return;
  const FocusView focus = view();
  const CommandOffer down = offerFocusStep(focus, -row_->step()), up = offerFocusStep(focus, row_->step());
  row_->offer(0, down.refusal.empty());
  row_->offer(1, up.refusal.empty());
  const std::string refusal = down.refusal.empty() ? up.refusal : down.refusal;
  row_->setText(refusal.empty() ? up.effect + "; or Ctrl and the wheel" : refusal, !refusal.empty());
}

}  // namespace microinjection
