#include "rig/devices/eppendorf/eppendorf_driver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rig/devices/eppendorf/eppendorf_protocol.h"

namespace microinjection {
namespace {

constexpr double kFastest = 7500;  // um/s, of an axis
constexpr double kSlower = 0.8;    // of the wanted speed, which is not kept to the last fifth for the line's sake

PolledManipulator::Dialect dialect() {
  PolledManipulator::Dialect dialect;
  dialect.device = "Eppendorf PatchMan NP 2 or InjectMan NI 2";
  dialect.short_name = "Eppendorf";
  dialect.guarded_stop = "\r" + eppendorfStop() + "\r";  // half a command ends before it, and is stopped at once
  dialect.farewell = eppendorfManual() + "\r";
  dialect.stop = eppendorfStop();
  dialect.position = eppendorfPosition();
  dialect.longest_move = 50;
  dialect.longest_reading = 36;
  dialect.stop_duration = 10e-3;  // assumed; the answer to a stop comes when it stands
  dialect.moved_by_hand = false;
  return dialect;
}

/// How far a motion leaves the straight line (in the way's unit) whose axes each go their part of the way at a speed of
/// their own: furthest when one of them has arrived.
double asideOf(const Eigen::Vector3d& way, const Eigen::Vector3d& speeds) {
  const Eigen::Vector3d line = way.normalized();
  double furthest = 0;
  for (int i = 0; i < 3; ++i) {
    if (way[i] == 0) continue;
    const double time = std::abs(way[i]) / speeds[i];
    const Eigen::Vector3d gone = way.array().sign().matrix().cwiseProduct((speeds * time).cwiseMin(way.cwiseAbs()));
    furthest = std::max(furthest, (gone - line * line.dot(gone)).norm());
  }
  return furthest;
}

}  // namespace

EppendorfDriver::EppendorfDriver(const EppendorfConfig& config, std::unique_ptr<Wire> wire)
    : PolledManipulator(config, std::move(wire), dialect()) {}

std::string EppendorfDriver::setup(int step) const { return step == 0 ? eppendorfRemote() : ""; }

std::string EppendorfDriver::takeSetup(int /*step*/, const std::string& answer) {
  return isEppendorfAnswer(answer, eppendorfRemote()) ? "" : "it does not go to remote control";
}

/// It refuses a stop when it is not under remote control.
std::string EppendorfDriver::askKept(const std::string& /*setting*/) const { return eppendorfStop(); }

bool EppendorfDriver::isKept(const std::string& /*setting*/, const std::string& answer) const {
  return isEppendorfAnswer(answer, eppendorfStop());
}

std::optional<Eigen::Vector3d> EppendorfDriver::readPosition(const std::string& answer) {
  const std::optional<EppendorfPosition> position = readEppendorfPosition(answer);
  if (!position) return std::nullopt;
  limits_ = position->limits;
  return position->place;
}

bool EppendorfDriver::acknowledges(const std::string& line, const std::string& answer) const {
  return isEppendorfAnswer(answer, line);
}

/// Each axis has a speed of its own. Of the whole speeds that are not faster than the wanted one, and not much slower,
/// those are taken that keep best to the line, or the fastest that keep to it within a count. Where there are none, an
/// axis would have to go slower than 1 um/s, and the move is faster than it should be.
PolledManipulator::Plan EppendorfDriver::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                                              const Eigen::Vector3d& fastest) const {
  const Eigen::Vector3d way = to - from, most = (fastest.array() * 1e6 + 1e-6).floor().min(kFastest);
  const Eigen::Vector3d wanted = way.cwiseAbs().normalized() * speed * 1e6;
  const auto rounded = [&](double part) -> Eigen::Vector3d {
    const Eigen::Vector3d whole = (wanted * part).array().round().min(most.array()).max(1);
    return (way.array() == 0).select(0, whole);
  };
  Eigen::Vector3d speeds = rounded(1);
  double aside = std::numeric_limits<double>::infinity();
  for (double part = 1; part > kSlower && aside > 1; part -= 0.02) {
    const Eigen::Vector3d each = rounded(part);
    if (each.norm() > 1.001 * wanted.norm() || asideOf(way, each) >= aside) continue;
    speeds = each;
    aside = asideOf(way, each);
  }
  const Eigen::Vector3d times = (way.array() == 0).select(0, way.cwiseAbs().cwiseQuotient(speeds));
  std::array<long, 3> place{};
  std::array<int, 3> said{};
  for (int i = 0; i < 3; ++i) {
    place[i] = std::lround(to[i]);
    said[i] = static_cast<int>(speeds[i]);
  }
  return {"", eppendorfGoTo(place, said), times.maxCoeff(), speeds.norm() * 1e-6, asideOf(way, speeds)};
}

std::string EppendorfDriver::whyNotArrived() const {
  return limits_ == 0 ? "" : "a limit switch is reached (" + std::to_string(limits_) + ")";
}

}  // namespace microinjection
