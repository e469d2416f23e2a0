#include "nodes/runtime/receipt.h"

#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kClockSkew = 0.05;  // s, by which a stamp may be ahead

}  // namespace

bool Receipt::isOld(double timeout, const ros::Time& now, const ros::SteadyTime& steady) const {
  const double age = secondsBetween(stamp_, now);
  return received_.isZero() || age > timeout || age < -kClockSkew || secondsBetween(received_, steady) > timeout;
}

}  // namespace microinjection
