#include "cell/surrogate/passive_correction.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

Eigen::Vector3d PassiveCorrection::step(const Eigen::Vector3d& displacement, const Eigen::Vector3d& wanted,
                                        double energy) {
  constexpr double kFullShare = 0.5;  // share of the reserve in the tank for which the whole correction applies
  const Eigen::Vector3d move = displacement - displacement_;
  const double before = tank_ - 0.5 * applied_.dot(move), cost = 0.5 * wanted.dot(move);
  const double needed = kFullShare * kReserve * std::abs(energy);
  double share = needed > 0 ? std::clamp((before - cost) / needed, 0.0, 1.0) : 0;
  if (cost > 0 && share * cost > before) share = std::max(0.0, before / cost);
  tank_ = before - share * cost;  // a long step may leave a debt, which is paid back first
  displacement_ = displacement;
  applied_ = share * wanted;
  return applied_;
}

}  // namespace microinjection
