#include "trial/injection_rig.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace microinjection {

InjectionRig::InjectionRig(const Config& config, const ManipulatorGeometry& geometry, ScaledCell& cell)
    : geometry_(geometry),
      device_(geometry, config.manipulator),
      manipulator_(geometry, CollisionGuard(), {}, device_),
      sensor_(config.sensor),
      injector_(config.injector),
      controller_(config.controller),
      cell_(&cell),
      disturbance_(config.disturbance),
      expected_(config.expected),
      flow_(config.injector.pipette),
      image_(config.interface),
      random_(config.interface.seed) {
  Eigen::Isometry3d pose = geometry.tip_at_zero;
  pose.translation() = config.start;
  const std::string refusal = manipulator_.movePosition(pose);
  if (!refusal.empty()) throw std::runtime_error("the rig cannot go where it starts: " + refusal);
  // Out of the cell, before anything is watched.
  int rested = 0;
  while (rested < 100) {
    time_ += kStep;
    manipulator_.step(time_, kStep);
    rested = manipulator_.moving() ? 0 : rested + 1;
  }
  began_ = time_;
  const auto abilities = device_.abilities();
  controller_.adaptTo(abilities.speed, abilities.latency + abilities.command_interval);
  controller_.command("enable");
}

bool InjectionRig::isIn(Disturbance::Kind kind) const {
  constexpr double kStands = 3;  // s
  const double since = sinceDisturbance();
  return disturbance_.kind == kind && since >= 0 && (kind != Disturbance::Kind::kRigStands || since < kStands);
}

Eigen::Vector3d InjectionRig::tip() const {
  Eigen::Vector3d tip = geometry_.tip(device_.trueJoints());
  if (isIn(Disturbance::Kind::kNeedleDrift)) tip.z() += disturbance_.size * sinceDisturbance();
  return tip;
}

void InjectionRig::read(const Eigen::Vector3d& force) {
  if (isIn(Disturbance::Kind::kSensorFrozen)) return;
  reading_ = sensor_.sample({force.z(), force.x()}, kStep);
  if (isIn(Disturbance::Kind::kSensorOffset)) reading_.x() += disturbance_.size;
  if (isIn(Disturbance::Kind::kSensorDrift)) reading_.x() += disturbance_.size * sinceDisturbance();
}

std::optional<Eigen::Vector3d> InjectionRig::arriving(const std::optional<Eigen::Vector3d>& setpoint) {
  const double delay = isIn(Disturbance::Kind::kCommandsLate) ? disturbance_.size : 0;
  setpoints_.push_back(setpoint);
  while (setpoints_.size() > static_cast<std::size_t>(std::lround(delay / kStep)) + 1) setpoints_.pop_front();
  return isIn(Disturbance::Kind::kRigStands) ? std::nullopt : setpoints_.front();
}

void InjectionRig::run(double limit) {
  step();
  while (controller_.busy() && time_ < limit) step();
}

bool InjectionRig::holds() {
  const bool stood = isIn(Disturbance::Kind::kRigStands);  // it has yet to go where it was sent last
  while (isIn(Disturbance::Kind::kRigStands)) step();
  for (int i = 0; i < (stood ? 1000 : 200); ++i) step();
  const Eigen::Vector3d before = tip();
  for (int i = 0; i < 500; ++i) step();
  return (tip() - before).norm() < 1e-8 && !controller_.pulse() && !injector_.reading().busy;
}

/// What the controller sees of the interface now.
std::optional<InterfaceReading> InjectionRig::interface() {
  constexpr double kPeriod = 0.02;  // s
  if (!image_.seen) return std::nullopt;
  if (time_ >= next_frame_) {
    const double noise = std::normal_distribution<double>(0, image_.noise)(random_);
    frames_.push_back({time_, cell_->boreLength() + noise});
    next_frame_ = time_ + kPeriod;
  }
  const bool arrives = !frames_.empty() && time_ >= frames_.front().time + image_.latency;
  if (arrives) {
    seen_ = frames_.front().position;
    frames_.pop_front();
  }
  return seen_ ? std::optional(InterfaceReading{*seen_, arrives}) : std::nullopt;
}

/// Gives the injector what the controller wants of it.
void InjectionRig::command(const std::optional<PulseGoal>& pulse) {
  if (pulse && !pulsing_ && !isIn(Disturbance::Kind::kInjectorDead))
    injector_.pulse({++pulses_, pulse->pressure, pulse->duration});
  if (pulse && pulsing_) injector_.adjust(pulse->pressure);
  if (!pulse && pulsing_ && injector_.reading().busy) injector_.stop();
  pulsing_ = pulse.has_value();
}

void InjectionRig::step(const std::optional<Eigen::Vector3d>& target) {
  time_ += kStep;
  const Eigen::Vector3d tip = this->tip();
  cell_->setBoreLine({flow_.restPressure() - injector_.reading().pressure, flow_.resistance()});
  const Eigen::Vector3d force = cell_->step(tip, time_);
  monitor(force, tip);
  read(force);
  InjectionController::Input input;
  input.target = target;
  if (const auto pose = manipulator_.tipPose()) input.needle = measured_ = pose->translation();
  input.force = Eigen::Vector3d(reading_.y(), 0, reading_.x());
  const InjectorReading& reading = injector_.reading();
  input.injector =
      InjectorReport{reading.busy, reading.volume, reading.last_id == pulses_, "", reading.pressure, reading.flow};
  input.interface = interface();
  input.expected = expected_;
  if (isIn(Disturbance::Kind::kForceLost) || !cell_->valid()) input.force.reset();  // as cell_simulator says it
  if (isIn(Disturbance::Kind::kNeedleLost)) input.needle.reset();
  const InjectionState before = controller_.injection();
  const int punctures_before = controller_.result().punctures;
  const auto setpoint = arriving(controller_.step(input, kStep));
  receive(before, punctures_before);
  if (setpoint) {
    Eigen::Isometry3d pose = geometry_.tip_at_zero;
    pose.translation() = *setpoint;
    manipulator_.servoPosition(pose);
  }
  command(controller_.pulse());
  monitorSuction(before == InjectionState::kAspirate && pulsing_);
  injector_.step(time_);
  manipulator_.step(time_, kStep);
}

void InjectionRig::monitor(const Eigen::Vector3d& force, const Eigen::Vector3d& tip) {
  truth_.valid = truth_.valid && cell_->valid();
  truth_.force = force.z();
  truth_.in_cell = cell_->inCell();
  truth_.peak_force = std::max(truth_.peak_force, std::abs(force.z()));
  if (cell_->touched() && !touch_height_) touch_height_ = tip.z();
  truth_.depth = touch_height_ ? *touch_height_ - tip.z() : 0;
  truth_.max_depth = std::max(truth_.max_depth, truth_.depth);
  if (cell_->layersPunctured() <= truth_.punctures) return;
  truth_.unfelt += truth_.punctures > felt_;
  truth_.punctures = cell_->layersPunctured();
  truth_.puncture_depth = truth_.depth;
  if (!truth_.zona_depth) truth_.zona_depth = truth_.depth;
  failed_at_ = time_;
}

void InjectionRig::monitorSuction(bool drawing) {
  const bool fails = failed_at_ == time_ && controller_.injection() == InjectionState::kAspirate;
  if (fails && !volume_at_break_) {
    truth_.broken_by_suction = true;
    volume_at_break_ = cell_->boreVolume();
  }
  if (!volume_at_break_ || controller_.injection() != InjectionState::kAspirate) return;
  truth_.drawn_too_much = std::max(truth_.drawn_too_much, cell_->boreVolume() - *volume_at_break_);
  if (!drawing && !truth_.suction_latency) truth_.suction_latency = time_ - failed_at_;
}

void InjectionRig::receive(InjectionState before, int punctures_before) {
  const bool touch = before == InjectionState::kApproach && controller_.injection() == InjectionState::kContact;
  truth_.false_detections += touch && !cell_->touched();
  if (controller_.result().punctures <= punctures_before) return;
  if (++felt_ > truth_.punctures) {
    ++truth_.false_detections;
    return;
  }
  truth_.latency = std::max(truth_.latency, time_ - failed_at_);
}

}  // namespace microinjection
