#include "nodes/imaging/arrival.h"

#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kClockSkew = 0.05;  // s, by which a stamp may be ahead

}  // namespace

bool Arrival::isOld(double timeout) const {
  const double age = secondsBetween(stamp_, ros::Time::now());
  return received_.isZero() || age > timeout || age < -kClockSkew ||
         secondsBetween(received_, ros::SteadyTime::now()) > timeout;
}

}  // namespace microinjection
