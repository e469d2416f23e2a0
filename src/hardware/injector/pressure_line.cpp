#include "hardware/injector/pressure_line.h"

#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace microinjection {

PressureLineConfig PressureLineConfig::read(ConfigReader& reader) {
  PressureLineConfig config;
  reader.number("syringe_compliance", config.syringe_compliance, Range::nonNegative());
  reader.number("tube_resistance", config.tube_resistance, Range::positive());
  reader.number("tube_compliance", config.tube_compliance, Range::positive());
  if (config.tube_resistance * config.tube_compliance < 1e-5)
    reader.error("tube_compliance", "times tube_resistance must be at least 1e-5 s");
  return config;
}

PressureLine::PressureLine(const PressureLineConfig& config, const PipetteConfig& pipette, double pressure)
    : config_(config),
      flow_(pipette),
      capillary_(flow_.restPressure() - pipette.outside_pressure),
      target_(pressure),
      driven_(pressure),
      piston_(pressure) {
  reading_.source = reading_.pipette = pressure;
  updateMouth();
}

void PressureLine::setTarget(double pressure) {
  target_ = pressure;
  piston_ = config_.syringe_compliance > 0 ? driven_ + pressure - reading_.source : pressure;
}

void PressureLine::setSource(double pressure) { target_ = driven_ = piston_ = reading_.source = pressure; }

void PressureLine::setSeal(const MouthSeal& seal) {
  seal_ = seal;
  updateMouth();
}

/// Flow and pressure at the mouth follow the pressure behind the pipette at once: the liquid has no inertia.
void PressureLine::updateMouth() {
  const bool sealed = std::isinf(seal_.resistance);
  const double drop = reading_.pipette - flow_.restPressure() - (sealed ? 0 : seal_.resistance * seal_.inflow);
  reading_.flow = sealed ? -seal_.inflow : drop / (flow_.resistance() + seal_.resistance);
  reading_.mouth = reading_.pipette - capillary_ - flow_.resistance() * reading_.flow;
}

void PressureLine::step(double time) {
  const double dt = begun_ ? time - time_ : 0;
  begun_ = true;
  time_ = time;
  if (!(dt > 0)) return;
  const double tube = 1 / (config_.tube_resistance * config_.tube_compliance);  // 1/s
  const bool has_syringe = config_.syringe_compliance > 0;
  const double syringe = has_syringe ? 1 / (config_.tube_resistance * config_.syringe_compliance) : 0;
  const double piston = 1 / config_.rise_time, c = config_.tube_compliance;
  // q / C = leak p + constant
  const double leak = std::isinf(seal_.resistance) ? 0 : 1 / ((flow_.resistance() + seal_.resistance) * c);
  const double constant =
      leak == 0 ? -seal_.inflow / c : -leak * (flow_.restPressure() + seal_.resistance * seal_.inflow);
  enum { kDriven, kSource, kPipette, kVolume, kOne };  // the volume as one of the tube, Pa; the last is 1
  Eigen::Matrix<double, 5, 5> rate = Eigen::Matrix<double, 5, 5>::Zero();
  rate(kDriven, kDriven) = -piston;
  rate(kDriven, kOne) = piston * piston_;
  rate.row(kSource) = rate.row(kDriven);
  rate(kSource, kSource) -= syringe;
  rate(kSource, kPipette) += syringe;
  rate(kVolume, kPipette) = leak;
  rate(kVolume, kOne) = constant;
  rate.row(kPipette) = -rate.row(kVolume);
  rate(kPipette, kSource) += tube;
  rate(kPipette, kPipette) -= tube;
  Eigen::Matrix<double, 5, 1> state;
  state << driven_, reading_.source, reading_.pipette, 0, 1;
  const Eigen::Matrix<double, 5, 5> through = (rate * dt).exp();
  state = through * state;
  driven_ = state[kDriven];
  reading_.source = state[kSource];
  reading_.pipette = state[kPipette];
  reading_.volume += c * state[kVolume];
  updateMouth();
}

}  // namespace microinjection
