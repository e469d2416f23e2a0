#include "lab_stage.h"

#include <cmath>
#include <stdexcept>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kMotorSpeed = 3e-3;  // m/s, the largest

}  // namespace

void LabStage::inject(const std::string& fault, const ros::Time& now) {
  const std::size_t colon = fault.find(':');
  const std::string kind = fault.substr(0, colon);
  if (kind == "silence" || kind == "pull") {
    silent_until = now + durationOf(std::stod(fault.substr(colon + 1)));
  } else if (kind == "error") {
    state = "FAULT";
  } else {
    throw std::invalid_argument("a stage has no fault " + fault);
  }
}

LabStageNode::LabStageNode(Bus& bus, LabStage& stage) : bus_(bus), stage_(stage) {
  using cell_microinjection::OperatingState;
  using cell_microinjection::StringStamped;
  using geometry_msgs::PoseStamped;
  using sensor_msgs::JointState;
  stage_.state = stage_.first_state;
  if (!stage_.pursues_old_targets) stage_.target = stage_.position;
  joints_ = bus.advertise<JointState>("my_rig/measured_js", 10);
  poses_ = bus.advertise<PoseStamped>("my_rig/measured_cp", 10);
  states_ = bus.advertise<OperatingState>("my_rig/operating_state", 10, true);
  joint_commands_ = bus.subscribe<JointState>("my_rig/servo_jp", 10, [this](const auto& delivery) {
    const auto& position = delivery.message->position;
    aim({position.at(0), position.at(1), position.at(2)});
  });
  pose_commands_ = bus.subscribe<PoseStamped>("my_rig/servo_cp", 10, [this](const auto& delivery) {
    const Eigen::Vector3d place = toVector(delivery.message->pose.position);
    aim(stage_.frame == "world" ? stage_.geometry.joints(place) : place);
  });
  words_ = bus.subscribe<StringStamped>("my_rig/state_command", 10,
                                        [this](const auto& delivery) { command(delivery.message->string); });
  bus.setStep(1e-3, [this](const ros::Time& now) { step(now); });
}

void LabStageNode::command(const std::string& word) {
  stage_.last_word = word;
  const bool enables = word == "enable" || (word == "resume" && stage_.state == "PAUSED");
  if (!enables || stage_.state == "ENABLED") return;
  if (!stage_.pursues_old_targets) stage_.target = stage_.position;
  stage_.state = "ENABLED";
}

void LabStageNode::aim(const Eigen::Vector3d& target) {
  if (stage_.state == "ENABLED") stage_.target = target;
}

void LabStageNode::move(double dt) {
  stage_.position.x() += stage_.own_speed * dt;
  if (stage_.state != "ENABLED" || !stage_.obeys) return;
  const Eigen::Vector3d way = (stage_.target - stage_.position) * (1 - std::exp(-dt / stage_.time_constant));
  const double largest = kMotorSpeed * dt;
  stage_.position += way.cwiseMax(-largest).cwiseMin(largest);
}

void LabStageNode::step(const ros::Time& now) {
  const double dt = stepped_.isZero() ? 1e-3 : secondsBetween(stepped_, now);
  stepped_ = now;
  if (now < stage_.silent_until) return;
  move(dt);
  if (stage_.state != told_state_ || stage_.homed != told_homed_) change(stage_.state);
  if (isDue(told_, now, stage_.period)) tell(now);
}

void LabStageNode::change(const std::string& state) {
  cell_microinjection::OperatingState message;
  message.header.stamp = bus_.now();
  message.state = told_state_ = state;
  message.is_homed = told_homed_ = stage_.homed;
  states_.publish(message);
}

void LabStageNode::tell(const ros::Time& now) {
  told_ = now;
  if (!stage_.repeats_stamp) stamp_ = now;
  const ros::Time stamp = stage_.stamps_nothing ? ros::Time() : stamp_;
  const Eigen::Vector3d told = stage_.position.array() + stage_.told_beside;
  sensor_msgs::JointState joints;
  joints.header.stamp = stamp;
  joints.name = {"x", "y", stage_.joint};
  joints.position.assign(told.data(), told.data() + 3);
  joints_.publish(joints);
  const Eigen::Vector3d place = stage_.frame == "world" ? stage_.geometry.tip(told) : told;
  poses_.publish(toPose(place, stamp, stage_.frame));
}

}  // namespace microinjection
