#include "rig/devices/eppendorf/eppendorf_driver.h"

#include <algorithm>
#include <cmath>

#include "rig/devices/eppendorf/eppendorf_protocol.h"

namespace microinjection {
namespace {

PolledManipulator::Dialect dialect() {
  PolledManipulator::Dialect dialect;
  dialect.device = "Eppendorf PatchMan NP 2 or InjectMan NI 2";
  dialect.short_name = "Eppendorf";
  dialect.guarded_stop = "\r" + eppendorfStop() + "\r";  // half a command ends before it, and is stopped at once
  dialect.stop = eppendorfStop();
  dialect.position = eppendorfPosition();
  dialect.longest_move = 50;
  dialect.longest_reading = 36;
  dialect.stop_duration = 10e-3;  // assumed; the answer to a stop comes when it stands
  dialect.moved_by_hand = false;
  return dialect;
}

}  // namespace

EppendorfDriver::EppendorfDriver(const EppendorfConfig& config, std::unique_ptr<Wire> wire)
    : PolledManipulator(config, std::move(wire), dialect()) {}

EppendorfDriver::~EppendorfDriver() { say("\r" + eppendorfManual() + "\r"); }

std::string EppendorfDriver::setup(int step) const { return step == 0 ? eppendorfRemote() : ""; }

std::string EppendorfDriver::takeSetup(int /*step*/, const std::string& answer) {
  return isEppendorfAnswer(answer, eppendorfRemote()) ? "" : "it does not go to remote control";
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

/// Each axis has a speed of its own, so that the way is straight but for the rounding of the speeds.
PolledManipulator::Plan EppendorfDriver::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                                              const Eigen::Vector3d& fastest) {
  const Eigen::Vector3d way = to - from;
  std::array<long, 3> place{};
  std::array<int, 3> speeds{};
  Plan plan{{}, 0};
  for (int i = 0; i < 3; ++i) {
    place[i] = std::lround(to[i]);
    const double share = std::abs(way[i]) / way.norm();
    if (share == 0) continue;
    const double most = std::min(fastest[i] * 1e6 + 1e-6, 7500.0);
    speeds[i] = std::max(1, static_cast<int>(std::min(std::round(speed * share * 1e6), std::floor(most))));
    plan.duration = std::max(plan.duration, std::abs(way[i]) / speeds[i]);
  }
  plan.lines = {eppendorfGoTo(place, speeds)};
  return plan;
}

std::string EppendorfDriver::whyNotArrived() const {
  return limits_ == 0 ? "" : "a limit switch is reached (" + std::to_string(limits_) + ")";
}

}  // namespace microinjection
