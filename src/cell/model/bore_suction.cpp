#include "cell/model/bore_suction.h"

#include <algorithm>
#include <cmath>

#include <boost/math/tools/toms748_solve.hpp>

namespace microinjection {

void BoreSuction::step(const CellModel::BoreLine& line, Cover cover, double dt) {
  if (cover == Cover::kMedium) reading_ = {};
  reading_.covered = cover != Cover::kMedium;
  const double before = reading_.volume;
  if (cover != Cover::kMedium && dt > 0) drawIn(line, cover, dt);
  // A bore with nothing of the cell in it pushes its liquid out, or draws the medium in.
  const bool liquid = cover == Cover::kMedium || (line.suction <= 0 && reading_.volume == 0);
  if (liquid) {
    reading_.flow = line.suction / line.resistance;
  } else {
    reading_.flow = dt > 0 ? (reading_.volume - before) / dt : reading_.flow;
  }
}

double BoreSuction::viscousResistance() const {
  const double a = config_.radius;
  return config_.viscosity * (3 / (a * a * a) + 8 * reading_.length / (M_PI * a * a * a * a));
}

/// Pa, at the end of a step: V(s_e) - V = dt (s - s_e) / R, whose left side rises with s_e.
double BoreSuction::equilibriumSuction(double suction, double resistance, double dt) const {
  const double unit = std::pow(config_.radius, 3), strongest = tongue_.strongest();
  const double gain = dt / resistance * config_.modulus / unit, wanted = suction / config_.modulus;
  const auto excess = [&](double s) { return tongue_.volume(s) - reading_.volume / unit - gain * (wanted - s); };
  if (excess(strongest) <= 0) return strongest * config_.modulus;
  if (excess(0) >= 0) return 0;
  boost::uintmax_t iterations = 60;
  const auto bracket = boost::math::tools::toms748_solve(excess, 0.0, strongest,
                                                         boost::math::tools::eps_tolerance<double>(30), iterations);
  return (bracket.first + bracket.second) / 2 * config_.modulus;
}

void BoreSuction::drawIn(const CellModel::BoreLine& line, Cover cover, double dt) {
  const double resistance = line.resistance + viscousResistance(), a = config_.radius;
  const bool intact = cover == Cover::kMembrane;
  const double held = intact ? equilibriumSuction(line.suction, resistance, dt) : 0;
  const double strongest = tongue_.strongest() * config_.modulus;
  const double before = reading_.volume, tension = held * a / (2 * (1 - a / config_.cell_radius));
  reading_.suction = held;
  if (intact && held < strongest) {
    const double suction = held / config_.modulus;
    reading_.length = a * tongue_.length(suction);
    reading_.volume = a * a * a * tongue_.volume(suction);
    reading_.tension = tension;
    return;
  }
  reading_.volume = std::max(0.0, before + dt * (line.suction - held) / resistance);
  reading_.length = std::max(0.0, reading_.length + (reading_.volume - before) / (M_PI * a * a));
  if (reading_.volume == 0) reading_.length = 0;
  const double grown = std::max(0.0, reading_.length / a - tongue_.length(tongue_.strongest()));
  reading_.tension = tension * (1 + grown);
}

}  // namespace microinjection
