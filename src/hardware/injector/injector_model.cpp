#include "hardware/injector/injector_model.h"

#include <algorithm>
#include <cmath>
#include <sstream>

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
  if (refusal.empty()) refusal = drawRefusal(pulse.pressure);
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
  if (refusal.empty()) refusal = drawRefusal(pressure);
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

void InjectorModel::reset() {
  reading_.volume = reading_.drawn = reading_.interface = 0;
  reading_.limited = false;
}

std::string InjectorModel::drawRefusal(double pressure) const {
  if (!reading_.limited || pressure >= flow_.restPressure()) return "";
  std::ostringstream text;
  text << "draw_limit = " << config_.draw_limit << " m^3 is reached; push out what was drawn in first, or reset";
  return text.str();
}

/// m^3, out of the tip within `dt`, on the way to a pressure.
double InjectorModel::poured(double target, double dt) const {
  if (covered_flow_) return -*covered_flow_ * dt;
  // p = target + (p0 - target) exp(-t / tau), and its integral: the flow is linear in p, so this is
  // the exact volume.
  const double tau = config_.rise_time;
  const double mean = target + (reading_.pressure - target) * tau * -std::expm1(-dt / tau) / dt;
  return flow_.flow(mean, clogging_) * dt;
}

/// m^3, that is drawn in until the pressure rests, once the target is the rest pressure.
double InjectorModel::coast() const {
  return covered_flow_ ? 0 : -config_.rise_time * flow_.flow(reading_.pressure, clogging_);
}

/// s, until the flow turns round on the way to a pressure; infinite: it does not.
double InjectorModel::crossing(double target) const {
  const double rest = flow_.restPressure();
  if (covered_flow_) return INFINITY;
  if (!((reading_.pressure - rest) * (target - rest) < 0)) return INFINITY;
  return config_.rise_time * std::log((reading_.pressure - target) / (rest - target));
}

/// s, until the balance must become the rest pressure; infinite: it need not. What is drawn in and what will be until
/// the pressure rests grow together at the flow of the target, evenly, since the regulator and the flow are linear.
double InjectorModel::untilLimit(double target) const {
  if (config_.draw_limit == 0 || target >= flow_.restPressure()) return INFINITY;
  if (covered_flow_)
    return *covered_flow_ > 0 ? std::max(0.0, config_.draw_limit - reading_.drawn) / *covered_flow_ : INFINITY;
  const double turn = crossing(target);
  const double begin = std::isinf(turn) ? 0 : turn;
  const double drawn = begin > 0 ? std::max(0.0, reading_.drawn - poured(target, begin)) : reading_.drawn + coast();
  return begin + std::max(0.0, (config_.draw_limit - drawn) / -flow_.flow(target, clogging_));
}

void InjectorModel::follow(double target, double dt) {
  if (!(dt > 0)) return;
  const double volume = poured(target, dt), turn = crossing(target);
  const double before = turn < dt ? poured(target, turn) : 0;
  reading_.drawn = std::max(0.0, std::max(0.0, reading_.drawn - before) - (volume - before));
  reading_.volume += volume;
  reading_.pressure = target + (reading_.pressure - target) * std::exp(-dt / config_.rise_time);
}

void InjectorModel::advance(double target, double dt) {
  const double limit = untilLimit(target);
  follow(target, std::min(dt, limit));
  if (limit < dt) {
    stop();
    balance_ = flow_.restPressure();
    reading_.limited = true;
    follow(balance_, dt - limit);
  }
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
  reading_.flow = flowNow();
  reading_.interface = interfaceDepth(config_.pipette, reading_.drawn);
  if (reading_.drawn + coast() < config_.draw_limit * (1 - 1e-6)) reading_.limited = false;
}

}  // namespace microinjection
