#include "hardware/devices/eppendorf/eppendorf_driver.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "hardware/devices/axis_speeds.h"
#include "hardware/serial/wire.h"

namespace microinjection {
namespace {

/// The line of a device that replies to a go-to at its end (C006). That reply comes at any time,
/// also between a request and its reply, and the position tells the same. So it is taken out of
/// what is read; everything else passes unchanged.
class EppendorfWire : public Wire {
 public:
  explicit EppendorfWire(std::unique_ptr<Wire> wire) : wire_(std::move(wire)) {}

  void setGuardedStop(const std::string& bytes) override { wire_->setGuardedStop(bytes); }
  GuardReport heartbeat() override { return wire_->heartbeat(); }
  std::string open() override {
    line_.clear();
    return wire_->open();
  }
  bool isOpen() const override { return wire_->isOpen(); }
  void write(const std::string& bytes, double time) override { wire_->write(bytes, time); }
  std::string read(double time) override {
    std::string passed;
    for (const char each : wire_->read(time)) {
      line_ += each;
      if (mayBeEppendorfMoveEnd(line_)) continue;  // the rest of it decides
      if (!isEppendorfMoveEnd(line_)) passed += line_;
      line_.clear();
    }
    return passed;
  }

 private:
  std::unique_ptr<Wire> wire_;
  std::string line_;  // the beginning of such a reply
};

constexpr double kFastest = 7.5e-3;  // m/s, of an axis

PolledManipulator::Dialect dialect(const EppendorfConfig& config) {
  const bool microsteps = config.unit() == EppendorfUnit::kMicrostep;
  PolledManipulator::Dialect dialect;
  dialect.device = microsteps ? "Eppendorf TransferMan NK 2" : "Eppendorf PatchMan NP 2 or InjectMan NI 2";
  dialect.short_name = "Eppendorf";
  dialect.guarded_stop = "\r" + eppendorfStop() + "\r";  // ends an incomplete command, and stops it at once
  dialect.farewell = eppendorfManual() + "\r";
  dialect.stop = eppendorfStop();
  dialect.position = eppendorfPosition(config.unit());
  dialect.longest_move = microsteps ? 83 : 50;
  dialect.longest_reading = 36;
  dialect.stop_duration = 10e-3;  // assumed; the reply to a stop comes at rest
  dialect.moved_by_hand = false;
  return dialect;
}

}  // namespace

EppendorfConfig EppendorfConfig::read(ConfigReader& reader) {
  EppendorfConfig config;
  config.readCommon(reader, 19200, {1e-6, kFastest});
  reader.number("microsteps_per_metre", config.microsteps_per_metre, Range::closed(0, 1e9));
  return config;
}

EppendorfDriver::EppendorfDriver(const EppendorfConfig& config, std::unique_ptr<Wire> wire)
    : PolledManipulator(config,
                        config.unit() == EppendorfUnit::kMicrostep ? std::make_unique<EppendorfWire>(std::move(wire))
                                                                   : std::move(wire),
                        dialect(config)),
      config_(config) {}

/// Remote control is the last, which is asked for again after a failure. At the first time positions
/// in both units precede it where they must agree.
std::string EppendorfDriver::setup(int step) const {
  const int readings = config_.unit() == EppendorfUnit::kMicrostep && !compared_ ? 2 : 0;
  if (step < readings) return eppendorfPosition(step == 0 ? EppendorfUnit::kMicrometre : EppendorfUnit::kMicrostep);
  return step == readings ? eppendorfRemote() : "";
}

std::string EppendorfDriver::handleSetup(int step, const std::string& reply) {
  const std::string line = setup(step);
  if (line == eppendorfRemote()) {
    compared_ = isEppendorfReply(reply, line);
    return compared_ ? "" : "it does not go to remote control";
  }
  const auto position =
      readEppendorfPosition(reply, step == 0 ? EppendorfUnit::kMicrometre : EppendorfUnit::kMicrostep);
  if (!position) return "no position";
  if (step == 0) micrometres_ = position->coordinates;
  return step == 0 ? "" : checkMicrosteps(position->coordinates);
}

/// Compares the microsteps of a micrometre with those of the file, where the device is far enough
/// from its 0 to tell.
std::string EppendorfDriver::checkMicrosteps(const Eigen::Vector3d& microsteps) const {
  constexpr double kFar = 200, kAgree = 0.01;  // um, share
  Eigen::Index motor = 0;
  if (micrometres_.cwiseAbs().maxCoeff(&motor) < kFar) return "";
  const double told = microsteps[motor] / micrometres_[motor], wanted = config_.microsteps_per_metre * 1e-6;
  if (std::abs(told / wanted - 1) < kAgree) return "";
  return "motor " + std::to_string(motor + 1) + " is at " + std::to_string(std::lround(micrometres_[motor])) +
         " um, so it has " + std::to_string(told) + " microsteps a micrometre; microsteps_per_metre of the file has " +
         std::to_string(wanted);
}

/// The device refuses a stop unless it is under remote control.
std::string EppendorfDriver::settingQuery(const std::string& /*setting*/) const { return eppendorfStop(); }

bool EppendorfDriver::isKept(const std::string& /*setting*/, const std::string& reply) const {
  return isEppendorfReply(reply, eppendorfStop());
}

std::optional<Eigen::Vector3d> EppendorfDriver::readPosition(const std::string& reply) {
  const std::optional<EppendorfPosition> position = readEppendorfPosition(reply, config_.unit());
  if (!position) return std::nullopt;
  limits_ = position->limits;
  return position->coordinates;
}

bool EppendorfDriver::acknowledges(const std::string& line, const std::string& reply) const {
  const bool told = line.find('\r') != std::string::npos;  // its position, at the end of the line
  return told ? readEppendorfPosition(reply, config_.unit()).has_value() : isEppendorfReply(reply, line);
}

/// Each axis has a speed of its own, a whole number of counts a second.
PolledManipulator::Plan EppendorfDriver::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                                              const Eigen::Vector3d& fastest) const {
  const double per_metre = 1 / count();
  const Eigen::Vector3d most = (fastest.array() * per_metre + 1e-6).floor().min(kFastest * per_metre);
  const AxisSpeeds chosen = straightSpeeds(to - from, speed * per_metre, most, 1,
                                           [](double each) { return std::max(1.0, std::round(each)); });
  std::array<long, 3> position{};
  std::array<int, 3> speeds{};
  for (int i = 0; i < 3; ++i) {
    position[i] = std::lround(to[i]);
    speeds[i] = static_cast<int>(chosen.speeds[i]);
  }
  const std::string line = config_.unit() == EppendorfUnit::kMicrostep ? eppendorfGoToMicrosteps(position, speeds)
                                                                       : eppendorfGoTo(position, speeds);
  return {"", line, chosen.duration, chosen.speeds.norm() * count(), chosen.deviation};
}

std::string EppendorfDriver::notArrivedReason() const {
  return limits_ == 0 ? "" : "a limit switch is reached (" + std::to_string(limits_) + ")";
}

}  // namespace microinjection
