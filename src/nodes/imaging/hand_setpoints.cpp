#include "nodes/imaging/hand_setpoints.h"

#include "base/errors.h"
#include "nodes/imaging/image_input.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kPatience = 10;   // s, for the controller to connect
constexpr double kEngaging = 0.5;  // s: the controller counts a hand's targets from the first that it has received
constexpr char kSetpoints[] = "/teleop/servo_cp";

}  // namespace

HandSetpoints::HandSetpoints(Bus& bus, const TipWatch& watch)
    : bus_(bus),
      watch_(watch),
      others_(subscribeGuarded<geometry_msgs::PoseStamped>(
          bus, kSetpoints, 1, [](const geometry_msgs::PoseStamped&, const std::string&) {})) {}

Eigen::Vector3d HandSetpoints::requireStart() const {
  if (watch_.controller().state != "ENABLED")
    throw ConfigError("the controller is " + watch_.controller().state + ", must be ENABLED");
  if (others_.publishers() > 0) throw ConfigError(std::string("another node publishes ") + kSetpoints);
  if (const std::string reason = watch_.cellInTheWay(); !reason.empty()) throw ConfigError(reason);
  const std::optional<Eigen::Vector3d> position = watch_.position();
  if (!position) throw ConfigError("/needle/measured_cp is silent or invalid");
  return *position;
}

void HandSetpoints::begin(const Eigen::Vector3d& start) {
  start_ = start;
  images_ = watch_.imageSize();
  begun_ = connected_ = bus_.steady();
  engaged_ = false;
  setpoints_ = bus_.advertise<geometry_msgs::PoseStamped>(kSetpoints, 1);
}

std::string HandSetpoints::interruption() const {
  if (watch_.controller().state != "ENABLED") return "the controller is " + watch_.controller().state;
  if (others_.publishers() > 1) return std::string("another node publishes ") + kSetpoints;
  if (!engaged_ && secondsBetween(begun_, bus_.steady()) > kPatience)
    return "the controller does not follow " + std::string(kSetpoints) + ": its mode must be manual";
  return sizeChange(images_, watch_.imageSize());
}

bool HandSetpoints::engage() {
  publish(start_);
  // This node's own subscription is one of them.
  if (setpoints_.subscribers() < 2) connected_ = bus_.steady();
  engaged_ = secondsBetween(connected_, bus_.steady()) > kEngaging;
  return engaged_;
}

void HandSetpoints::publish(const Eigen::Vector3d& setpoint) const {
  setpoints_.publish(toPose(watch_.poseAt(setpoint), bus_.now(), kWorldFrame));
}

}  // namespace microinjection
