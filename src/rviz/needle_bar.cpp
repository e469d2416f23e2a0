#include "rviz/needle_bar.h"

#include <QHBoxLayout>
#include <utility>

#include "rviz/session_clock.h"

namespace microinjection {
namespace {

constexpr double kBegins = 0.5;         // s after a step, in which the micromanipulator reports that it moves
constexpr double kMotionForgotten = 5;  // s after a step without a motion: a later motion is another one's

}  // namespace

NeedleBar::NeedleBar(std::function<SessionView()> newest, std::function<std::optional<Eigen::Isometry3d>()> pose,
                     QWidget* parent)
    : QWidget(parent),
      newest_(std::move(newest)),
      pose_(std::move(pose)),
      row_(new JogRow(
          "Needle", {"x -", "x +", "y -", "y +", "z -", "z +"}, {1e-6, 5e-6, 20e-6, 100e-6},
          [this](std::size_t button) { press(button); }, this)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(row_);
}

NeedleBar::~NeedleBar() = default;

void NeedleBar::start(Bus& bus) {
  if (bus_) return;
  bus_ = &bus;
  moves_ = bus.advertise<geometry_msgs::PoseStamped>("needle/move_cp", 1);
  stops_ = bus.advertise<cell_microinjection::StringStamped>("needle/state_command", 1);
  calibration_ = std::make_unique<ActionWatch>(bus, "calibration/calibrate");
  states_ =
      bus.subscribe<cell_microinjection::OperatingState>("needle/operating_state", 1, [this](const auto& delivery) {
        const cell_microinjection::OperatingState& message = *delivery.message;
        needle_.state = operatingStateOf(message.state);
        const bool ended = needle_.busy && !message.is_busy && sessionNow(*bus_) - sent_at_ > kBegins;
        if (ended) needle_.goal.reset();
        needle_.busy = message.is_busy;
      });
}

NeedleView NeedleBar::view() {
  const double since = needle_.busy ? 0 : sessionNow(*bus_) - sent_at_;
  if (since > kMotionForgotten) needle_.goal.reset();
  NeedleView view = needle_;
  // Kept in needle_: a report of the motion that comes late makes it count again, for STOP.
  if (since > kBegins) view.goal.reset();
  // A latched state outlives its node.
  if (states_.publishers() == 0) view.state.reset();
  if (const auto pose = pose_()) view.tip = pose->translation();
  view.calibrating = calibration_ && calibration_->active();
  return view;
}

void NeedleBar::press(std::size_t button) {
  if (!bus_) return;
  serveArrived(*bus_);
  const NeedleView needle = view();
  const auto pose = pose_();
  if (!pose || !offerNeedleStep(needle, newest_()).refusal.empty()) return;
  const double step = (button % 2 == 0 ? -1 : 1) * row_->step();
  needle_.goal = needleGoal(needle, step * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(button) / 2));
  sent_at_ = sessionNow(*bus_);
  geometry_msgs::PoseStamped message;
  message.header.stamp = bus_->now();
  message.header.frame_id = "world";
  message.pose.position.x = needle_.goal->x();
  message.pose.position.y = needle_.goal->y();
  message.pose.position.z = needle_.goal->z();
  const Eigen::Quaterniond turned(pose->linear());
  message.pose.orientation.x = turned.x();
  message.pose.orientation.y = turned.y();
  message.pose.orientation.z = turned.z();
  message.pose.orientation.w = turned.w();
  moves_.publish(message);
}

void NeedleBar::stop() {
  if (!bus_) return;
  // Whether a step is under way is known from messages that may have waited while rviz drew.
  serveArrived(*bus_);
  if (!view().goal) return;
  cell_microinjection::StringStamped message;
  message.header.stamp = bus_->now();
  message.string = "stop";
  stops_.publish(message);
  needle_.goal.reset();
}

void NeedleBar::refresh(const SessionView& session) {
  if (!bus_) return;
  const CommandOffer offered = offerNeedleStep(view(), session);
  const bool allowed = offered.refusal.empty();
  for (std::size_t i = 0; i < 6; ++i) row_->offer(i, allowed);
  row_->setText(allowed ? offered.effect : offered.refusal, !allowed);
}

}  // namespace microinjection
