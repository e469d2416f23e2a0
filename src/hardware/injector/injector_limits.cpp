#include "hardware/injector/injector_limits.h"

#include <sstream>

namespace microinjection {
namespace {

std::string outOf(const std::string& what, double value, const Eigen::Vector2d& range, const std::string& unit) {
  const Range allowed = Range::closed(range[0], range[1]);
  if (allowed.contains(value)) return "";
  std::ostringstream out;
  out << what << " = " << value << ' ' << unit << ", allowed " << allowed.text() << ' ' << unit;
  return out.str();
}

}  // namespace

InjectorLimits InjectorLimits::read(ConfigReader& reader) {
  InjectorLimits limits;
  reader.vector("pressure_range", limits.pressure_range, Range::closed(kVacuum, kHighestPressure));
  reader.vector("duration_range", limits.duration_range, {0, kLongestPulse, true, false});
  if (limits.pressure_range[0] > limits.pressure_range[1]) reader.error("pressure_range", "must be [lowest, highest]");
  if (limits.duration_range[0] > limits.duration_range[1])
    reader.error("duration_range", "must be [shortest, longest]");
  return limits;
}

std::string InjectorLimits::checkPressure(const std::string& what, double pressure) const {
  return outOf(what, pressure, pressure_range, "Pa");
}

std::string InjectorLimits::check(const InjectionPulse& pulse) const {
  const std::string pressure = checkPressure("pulse pressure", pulse.pressure);
  return pressure.empty() ? outOf("pulse duration", pulse.duration, duration_range, "s") : pressure;
}

}  // namespace microinjection
