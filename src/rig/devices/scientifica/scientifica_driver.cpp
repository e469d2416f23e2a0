#include "rig/devices/scientifica/scientifica_driver.h"

#include <cmath>

#include "rig/devices/scientifica/scientifica_protocol.h"

namespace microinjection {
namespace {

enum Step { kMaker, kVersion, kScaleX, kScaleY, kScaleZ, kAcceleration, kStartSpeed, kSteps };

PolledManipulator::Dialect dialect(const ScientificaConfig& config) {
  PolledManipulator::Dialect dialect;
  dialect.device = "Scientifica PatchStar (motion card " + std::to_string(config.version) + ")";
  dialect.short_name = "Scientifica";
  dialect.guarded_stop = "\rSTOP\r";  // half a command ends before it
  dialect.stop = "STOP";
  dialect.position = config.version == 2 ? "POS" : "P";
  dialect.motion = "S";
  dialect.longest_move = 50;
  dialect.longest_reading = 36;  // S and its answer are part of it
  dialect.stop_duration = config.speed / config.acceleration;
  dialect.moved_by_hand = true;
  return dialect;
}

}  // namespace

ScientificaDriver::ScientificaDriver(const ScientificaConfig& config, std::unique_ptr<Wire> wire)
    : PolledManipulator(config, std::move(wire), dialect(config)), config_(config) {}

double ScientificaDriver::count() const { return scientificaCount(config_.version); }

/// A motor's step is 1/64 um, so a count of version 3 need not be a place at which it can stand.
double ScientificaDriver::arrival() const { return config_.version == 2 ? 1 : 2; }

std::string ScientificaDriver::setup(int step) const {
  switch (step) {
    case kMaker:
      return "SCIENTIFICA";
    case kVersion:
      return "VER";
    case kScaleX:
    case kScaleY:
    case kScaleZ:
      return scientificaAskScale(config_.version, step - kScaleX);
    case kAcceleration:
      return "ACC " + std::to_string(scientificaAcceleration(config_.version, config_.acceleration));
    case kStartSpeed:
      return "FIRST " + std::to_string(scientificaTop(config_.version, scientificaSlowest(config_.version)));
    default:
      return "";
  }
}

std::string ScientificaDriver::takeSetup(int step, const std::string& answer) {
  const std::optional<double> number = readScientificaNumber(answer);
  switch (step) {
    case kMaker:
      return answer == "Y519" ? "" : "no card of Scientifica's";
    case kVersion:
      if (number && static_cast<int>(*number) == config_.version) return "";
      return "the file has version " + std::to_string(config_.version);
    case kScaleX:
    case kScaleY:
    case kScaleZ:
      if (number && std::abs(std::abs(*number) / scientificaScale(config_.version) - 1) < 1e-3) return "";
      return "its positions have another unit than a PatchStar's, whose scale is " +
             std::to_string(scientificaScale(config_.version)).substr(0, 6);
    default:
      return answer == "A" ? "" : "refused";
  }
}

/// A setting is a word and a number; the word alone asks for the number.
std::string ScientificaDriver::askKept(const std::string& setting) const {
  return setting.substr(0, setting.find(' '));
}

bool ScientificaDriver::isKept(const std::string& setting, const std::string& answer) const {
  return readScientificaNumber(answer) == readScientificaNumber(setting.substr(setting.find(' ') + 1));
}

std::optional<Eigen::Vector3d> ScientificaDriver::readPosition(const std::string& answer) {
  return readScientificaPosition(answer);
}

std::optional<bool> ScientificaDriver::readMotion(const std::string& answer) const {
  return readScientificaMotion(answer);
}

bool ScientificaDriver::acknowledges(const std::string& /*line*/, const std::string& answer) const {
  return answer == "A";
}

PolledManipulator::Plan ScientificaDriver::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                                                const Eigen::Vector3d& /*fastest*/) const {
  const int top = scientificaTop(config_.version, speed);
  const std::string move = scientificaGoTo({std::lround(to.x()), std::lround(to.y()), std::lround(to.z())});
  // It speeds up and slows down.
  const double way = (to - from).norm() * count(), v = scientificaSpeed(config_.version, top);
  const double a = config_.acceleration;
  const double duration = way > v * v / a ? way / v + v / a : 2 * std::sqrt(way / a);
  return {"TOP " + std::to_string(top), move, duration, v, 0};
}

}  // namespace microinjection
