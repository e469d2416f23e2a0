#include "rviz/pixel_goal_link.h"

#include <cell_microinjection/GoToPixelAction.h>

#include "operation/console/figures.h"
#include "rviz/session_clock.h"
#include "rviz/session_parameters.h"

namespace microinjection {
namespace {

using cell_microinjection::GoToPixelAction;
using cell_microinjection::GoToPixelFeedback;
using cell_microinjection::GoToPixelGoal;

constexpr double kClickForgotten = 60;  // s, after a click

std::string textOf(const GoToPixelFeedback& at) {
  const std::string far = figure(at.distance, 1, 1) + " px away";
  return at.waits_for.empty() ? far : far + ", waits: " + at.waits_for;
}

}  // namespace

class PixelGoalLink::Runner : public ActionRunner<GoToPixelAction> {
 public:
  using ActionRunner::ActionRunner;
};

PixelGoalLink::PixelGoalLink(Bus& bus)
    : bus_(bus), proposed_(bus.advertise<geometry_msgs::PointStamped>("visual_servo/proposed_pixel", 1, true)) {
  operating_ = bus.subscribe<cell_microinjection::OperatingState>(
      "controller/operating_state", 1, [this](const auto& delivery) { onOperating(*delivery.message); });
  injection_ = bus.subscribe<cell_microinjection::InjectionStatus>("controller/injection_state", 1,
                                                                   [this](const auto&) { onInjection(); });
  publish();  // what a console of before has proposed is forgotten
  runner_ = std::make_unique<Runner>(
      bus, "visual_servo/go_to_pixel", textOf,
      [this](const std::string& text) {
        if (goal_.under_way) report_ = {Light::kYellow, text};
      },
      [this](bool success, const std::string& message) { end(success, message); });
}

PixelGoalLink::~PixelGoalLink() { proposed_.publish(geometry_msgs::PointStamped()); }

void PixelGoalLink::poll() {
  serveArrived(bus_);
  if (goal_.under_way && !runner_->there()) {
    runner_->forget();
    end(false, "visual_servo has ended");
  }
  if (sessionNow(bus_) - proposed_at_ > kClickForgotten) discard();
}

SessionView PixelGoalLink::session() const {
  return sessionNow(bus_) - heard_at_ < kControllerSilence ? session_ : SessionView();
}

CommandOffer PixelGoalLink::offered() const { return offer(goal_, session(), runner_->there()); }

void PixelGoalLink::propose(const Eigen::Vector2d& pixel) {
  if (goal_.under_way) return;
  goal_.pixel = pixel;
  proposed_at_ = sessionNow(bus_);
  report_ = {};
  publish();
}

void PixelGoalLink::discard() {
  if (goal_.under_way || !goal_.pixel) return;
  goal_.pixel.reset();
  publish();
}

void PixelGoalLink::publish() {
  geometry_msgs::PointStamped message;
  if (goal_.pixel) {
    message.header.stamp = bus_.now();
    message.point.x = goal_.pixel->x();
    message.point.y = goal_.pixel->y();
  }
  proposed_.publish(message);
}

void PixelGoalLink::go() {
  poll();
  if (!offered().refusal.empty()) return;
  goal_.under_way = true;
  report_ = {Light::kYellow, "begins"};
  GoToPixelGoal goal;
  goal.x = goal_.pixel->x();
  goal.y = goal_.pixel->y();
  runner_->start(goal);
}

void PixelGoalLink::cancel() {
  if (goal_.under_way) runner_->cancel();
}

void PixelGoalLink::onOperating(const cell_microinjection::OperatingState& message) {
  const bool enabled = message.state == toText(OperatingState::kEnabled);
  session_.operating = enabled ? OperatingState::kEnabled : OperatingState::kDisabled;
  if (!enabled) discard();
}

/// The mode is a parameter that is set before the controller starts. To read it waits for the master,
/// which is why it is done only when a controller appears.
void PixelGoalLink::onInjection() {
  if (sessionNow(bus_) - heard_at_ > kControllerSilence) {
    session_.settings.mode = SessionParameters(bus_, "/injection_controller").text("mode");
  }
  heard_at_ = sessionNow(bus_);
}

void PixelGoalLink::end(bool success, const std::string& message) {
  goal_.under_way = false;
  discard();
  report_ = {success ? Light::kGreen : Light::kRed, success ? "the tip is there" : message};
}

}  // namespace microinjection
