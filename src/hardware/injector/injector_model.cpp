#include "hardware/injector/injector_model.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

InjectorModelConfig InjectorModelConfig::read(ConfigReader& reader) {
  InjectorModelConfig config;
  reader.number("rise_time", config.rise_time, Range::positive());
  config.limits = InjectorLimits::read(reader);
  reader.number("balance", config.balance, Range::finite());
  const std::string refusal = config.limits.checkPressure("balance", config.balance);
  if (!refusal.empty()) reader.error("balance", refusal);
  ConfigReader pipette = reader.section("pipette");
  config.pipette = PipetteConfig::read(pipette);
  return config;
}

InjectorModel::InjectorModel(const InjectorModelConfig& config)
    : config_(config), flow_(config.pipette), balance_(config.balance) {
  reading_.pressure = balance_;
  reading_.flow = flow_.flow(balance_);
}

std::string InjectorModel::pulse(const InjectionPulse& pulse) {
  if (pulse_) return "a pulse is under way";
  std::string refusal = config_.limits.check(pulse);
  if (!refusal.empty()) return refusal;
  open(pulse);
  left_ = pulse.duration;
  return "";
}

void InjectorModel::open(const InjectionPulse& pulse) {
  pulse_ = pulse;
  left_ = INFINITY;
  reading_.busy = true;
}

void InjectorModel::finish() {
  if (!pulse_) return;
  reading_.last_id = pulse_->id;
  ++reading_.pulses;
  stop();
}

std::string InjectorModel::setBalance(double pressure) {
  std::string refusal = config_.limits.checkPressure("balance pressure", pressure);
  if (refusal.empty()) balance_ = pressure;
  return refusal;
}

std::string InjectorModel::adjust(double pressure) {
  if (!pulse_) return "no pulse is under way";
  std::string refusal = config_.limits.checkPressure("pressure", pressure);
  if (refusal.empty()) pulse_->pressure = pressure;
  return refusal;
}

std::string InjectorModel::stop() {
  pulse_.reset();
  left_ = 0;
  reading_.busy = false;
  return "";
}

void InjectorModel::reset() { reading_.volume = 0; }

void InjectorModel::advance(double target, double dt) {
  // p = target + (p0 - target) exp(-t / tau), and its integral: the flow is linear in p, so this is
  // the exact volume.
  const double tau = config_.rise_time, decay = std::exp(-dt / tau), deviation = reading_.pressure - target;
  const double mean = target + deviation * tau * -std::expm1(-dt / tau) / dt;
  reading_.volume += flow_.flow(mean, clogging_) * dt;
  reading_.pressure = target + deviation * decay;
}

void InjectorModel::step(double time) {
  double dt = begun_ ? time - time_ : 0;
  begun_ = true;
  time_ = time;
  if (pulse_ && dt > 0) {
    const double part = std::min(dt, left_);
    advance(pulse_->pressure, part);
    left_ -= part;
    dt -= part;
    if (left_ <= 1e-9) finish();  // s; the rounding error of the sum of steps is smaller
  }
  if (dt > 0) advance(balance_, dt);
  reading_.flow = flow_.flow(reading_.pressure, clogging_);
}

}  // namespace microinjection
