#include "rig/devices/eppendorf/eppendorf_driver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rig/devices/eppendorf/eppendorf_protocol.h"

namespace microinjection {
namespace {

constexpr double kFastest = 7500;  // um/s, of an axis
constexpr double kSlower = 0.8;    // share of the wanted speed that is enough if the line is kept better

PolledManipulator::Dialect dialect() {
  PolledManipulator::Dialect dialect;
  dialect.device = "Eppendorf PatchMan NP 2 or InjectMan NI 2";
  dialect.short_name = "Eppendorf";
  dialect.guarded_stop = "\r" + eppendorfStop() + "\r";  // ends an incomplete command, and stops it at once
  dialect.farewell = eppendorfManual() + "\r";
  dialect.stop = eppendorfStop();
  dialect.position = eppendorfPosition();
  dialect.longest_move = 50;
  dialect.longest_reading = 36;
  dialect.stop_duration = 10e-3;  // assumed; the reply to a stop comes at rest
  dialect.moved_by_hand = false;
  return dialect;
}

/// Largest distance from the straight line (in the displacement's unit) of a motion whose axes each
/// move at a speed of their own. It occurs when one of them arrives.
double deviationOf(const Eigen::Vector3d& displacement, const Eigen::Vector3d& speeds) {
  const Eigen::Vector3d line = displacement.normalized();
  double furthest = 0;
  for (int i = 0; i < 3; ++i) {
    if (displacement[i] == 0) continue;
    const double time = std::abs(displacement[i]) / speeds[i];
    const Eigen::Vector3d travelled =
        displacement.array().sign().matrix().cwiseProduct((speeds * time).cwiseMin(displacement.cwiseAbs()));
    furthest = std::max(furthest, (travelled - line * line.dot(travelled)).norm());
  }
  return furthest;
}

}  // namespace

EppendorfConfig EppendorfConfig::read(ConfigReader& reader) {
  EppendorfConfig config;
  config.readCommon(reader, 19200, {1e-6, 7.5e-3});
  return config;
}

EppendorfDriver::EppendorfDriver(const EppendorfConfig& config, std::unique_ptr<Wire> wire)
    : PolledManipulator(config, std::move(wire), dialect()) {}

std::string EppendorfDriver::setup(int step) const { return step == 0 ? eppendorfRemote() : ""; }

std::string EppendorfDriver::handleSetup(int /*step*/, const std::string& reply) {
  return isEppendorfReply(reply, eppendorfRemote()) ? "" : "it does not go to remote control";
}

/// The device refuses a stop unless it is under remote control.
std::string EppendorfDriver::settingQuery(const std::string& /*setting*/) const { return eppendorfStop(); }

bool EppendorfDriver::isKept(const std::string& /*setting*/, const std::string& reply) const {
  return isEppendorfReply(reply, eppendorfStop());
}

std::optional<Eigen::Vector3d> EppendorfDriver::readPosition(const std::string& reply) {
  const std::optional<EppendorfPosition> position = readEppendorfPosition(reply);
  if (!position) return std::nullopt;
  limits_ = position->limits;
  return position->coordinates;
}

bool EppendorfDriver::acknowledges(const std::string& line, const std::string& reply) const {
  return isEppendorfReply(reply, line);
}

/// Each axis has a speed of its own, a whole number. The plan takes the fastest speeds, at most the
/// wanted one and not much slower, that stay within a count of the line, or else those closest to
/// it. If there are none, an axis would have to be slower than 1 um/s, and the move is faster than
/// wanted.
PolledManipulator::Plan EppendorfDriver::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                                              const Eigen::Vector3d& fastest) const {
  const Eigen::Vector3d displacement = to - from, most = (fastest.array() * 1e6 + 1e-6).floor().min(kFastest);
  const Eigen::Vector3d wanted = displacement.cwiseAbs().normalized() * speed * 1e6;
  const auto rounded = [&](double part) -> Eigen::Vector3d {
    const Eigen::Vector3d whole = (wanted * part).array().round().min(most.array()).max(1);
    return (displacement.array() == 0).select(0, whole);
  };
  Eigen::Vector3d speeds = rounded(1);
  double deviation = std::numeric_limits<double>::infinity();
  for (double part = 1; part > kSlower && deviation > 1; part -= 0.02) {
    const Eigen::Vector3d each = rounded(part);
    if (each.norm() > 1.001 * wanted.norm() || deviationOf(displacement, each) >= deviation) continue;
    speeds = each;
    deviation = deviationOf(displacement, each);
  }
  const Eigen::Vector3d times = (displacement.array() == 0).select(0, displacement.cwiseAbs().cwiseQuotient(speeds));
  std::array<long, 3> position{};
  std::array<int, 3> line_speeds{};
  for (int i = 0; i < 3; ++i) {
    position[i] = std::lround(to[i]);
    line_speeds[i] = static_cast<int>(speeds[i]);
  }
  return {"", eppendorfGoTo(position, line_speeds), times.maxCoeff(), speeds.norm() * 1e-6,
          deviationOf(displacement, speeds)};
}

std::string EppendorfDriver::notArrivedReason() const {
  return limits_ == 0 ? "" : "a limit switch is reached (" + std::to_string(limits_) + ")";
}

}  // namespace microinjection
