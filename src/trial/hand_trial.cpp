#include "trial/hand_trial.h"

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "base/errors.h"
#include "hardware/injector/pipette_flow.h"

namespace microinjection {
namespace {

constexpr double kStep = InjectionRig::kStep;
constexpr double kOut = 2e-6;                                 // m above where it touched, of a needle that is out again
constexpr double kAllowedForce = 1.2;                         // of the zona's strength, that is no excess
constexpr double kAllowedDepth = 0.35, kAllowedAside = 0.02;  // diameters
constexpr double kAllowedTime = 20;                           // s

TrainingTask taskOf(const InjectionCase& of, const PulseGoal& pulse) {
  TrainingTask task;
  task.peak_force = kAllowedForce * of.cell.puncture.layers.front().force;
  task.deformation = kAllowedDepth * of.cell.diameter;
  task.lateral_error = kAllowedAside * of.cell.diameter;
  task.time = kAllowedTime;
  task.punctures = static_cast<int>(of.cell.puncture.layers.size());
  task.volume = PipetteFlow(PipetteConfig()).flow(pulse.pressure) * pulse.duration;
  return task;
}

}  // namespace

ManipulatorGeometry geometryOf(const std::string& urdf_path) {
  std::ifstream file(urdf_path);
  if (!file) throw ConfigError(urdf_path + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return ManipulatorGeometry::fromUrdf(text.str());
}

InjectionRig::Disturbance randomFault(const InjectionCase& of, double share) {
  using Kind = InjectionRig::Disturbance::Kind;
  constexpr Kind kKinds[] = {Kind::kSensorFrozen, Kind::kSensorOffset, Kind::kSensorDrift,
                             Kind::kRigStands,    Kind::kCommandsLate, Kind::kNeedleDrift};
  std::mt19937 random(static_cast<unsigned>(of.seed) + 700000);
  const auto even = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const auto eitherSign = [&](double low, double high) {
    return (even(-1, 1) < 0 ? -1 : 1) * low * std::pow(high / low, even(0, 1));
  };
  if (even(0, 1) >= share) return {};
  const double strength = of.cell.puncture.layers.front().force;
  InjectionRig::Disturbance fault;
  fault.kind = kKinds[static_cast<std::size_t>(even(0, std::size(kKinds)))];
  fault.begin = even(0.5, 8);
  if (fault.kind == Kind::kSensorOffset) fault.size = strength * eitherSign(0.1, 1);
  if (fault.kind == Kind::kSensorDrift) fault.size = strength * eitherSign(0.02, 0.2);
  if (fault.kind == Kind::kCommandsLate) fault.size = even(0.05, 0.3);
  if (fault.kind == Kind::kNeedleDrift) fault.size = eitherSign(0.1e-6, 1e-6);
  return fault;
}

std::string toText(InjectionRig::Disturbance::Kind kind) {
  using Kind = InjectionRig::Disturbance::Kind;
  switch (kind) {
    case Kind::kNone:
      return "";
    case Kind::kForceLost:
      return "force_lost";
    case Kind::kNeedleLost:
      return "needle_lost";
    case Kind::kRigStands:
      return "commands_lost";
    case Kind::kInjectorDead:
      return "injector_dead";
    case Kind::kSensorFrozen:
      return "sensor_frozen";
    case Kind::kSensorOffset:
      return "sensor_offset";
    case Kind::kSensorDrift:
      return "sensor_drift";
    case Kind::kCommandsLate:
      return "commands_late";
    case Kind::kNeedleDrift:
      return "needle_drift";
  }
  return "";
}

HandTrial::HandTrial(const TrialCell& cell, const Config& config) : of_(randomInjectionCase(config.seed)) {
  if (!(config.force_delay >= 0 && config.force_delay <= 1)) throw ConfigError("force_delay: must be from 0 to 1 s");
  if (!(config.noise >= 0 && config.noise <= 100)) throw ConfigError("noise: must be from 0 to 100");
  if (!(config.faults >= 0 && config.faults <= 1)) throw ConfigError("faults: must be from 0 to 1");
  fault_ = randomFault(of_, config.faults);
  settings_ = injectionSettings(of_);
  settings_.mode = "manual";
  task_ = taskOf(of_, settings_.goal.pulse);
  cell_ = std::make_unique<ScaledCell>(cell.scene, cell.data, of_.cell);
  InjectionRig::Config rig;
  rig.controller = settings_;
  rig.disturbance = fault_;
  rig.sensor.seed = config.seed;
  for (Eigen::Vector2d* noise : {&rig.sensor.density, &rig.sensor.random_walk, &rig.sensor.drift_rate})
    *noise *= config.noise;
  rig.manipulator.seed = config.seed;
  rig.start = startOf(of_);
  rig_ = std::make_unique<InjectionRig>(rig, geometryOf(cell.urdf), *cell_);
  start_ = target_ = rig.start;
  delay_ = static_cast<std::size_t>(std::lround(config.force_delay / kStep));
  rig_->step(target_);
  readings_.push_back(rig_->reading());
}

void HandTrial::step(const Eigen::Vector3d& velocity, bool inject, int steps) {
  if (!velocity.allFinite() || velocity.cwiseAbs().maxCoeff() > kFastest * (1 + 1e-9))
    throw ConfigError("velocity: each part must be from -200e-6 to 200e-6 m/s");
  if (steps < 1 || steps > 100000) throw ConfigError("steps: must be from 1 to 100000");
  if (over_) throw ConfigError("the trial is over: begin another one");
  if (inject) notice_ = rig_->command("inject");
  for (int i = 0; i < steps && !over_; ++i) {
    target_ += kStep * velocity;
    rig_->step(target_);
    readings_.push_back(rig_->reading());
    if (readings_.size() > delay_ + 1) readings_.pop_front();
    true_force_ = rig_->truth().force;
    const InjectionController& controller = rig_->controller();
    TraineeSample sample;
    sample.time = rig_->time();
    sample.tip = rig_->tip();
    sample.force = rig_->truth().force * Eigen::Vector3d::UnitZ();
    if (rig_->truth().in_cell) sample.depth = std::max(0.0, rig_->truth().depth);
    sample.state = controller.injection();
    sample.volume = rig_->volume();
    sample.punctures = rig_->truth().punctures;
    training_.add(sample);
    touched_ = touched_ || rig_->truth().in_cell;
    const bool out = touched_ && !rig_->truth().in_cell && rig_->truth().depth < -kOut;
    over_ = out || controller.state() == OperatingState::kFault || rig_->time() > kLongest;
  }
}

HandTrial::Observation HandTrial::observation() const {
  const Eigen::Vector3d moved = rig_->measured() - start_;
  const Eigen::Vector2d& reading = readings_.front();
  const InjectionController& controller = rig_->controller();
  Observation all;
  all << rig_->time(), moved.x(), moved.y(), moved.z(), reading.x(), reading.y(), controller.monitor().depth(),
      static_cast<double>(controller.injection()), controller.punctures(), rig_->volume(), of_.cell.diameter,
      of_.believed_modulus, settings_.guards.force_limit, settings_.guards.depth_limit;
  return all;
}

}  // namespace microinjection
