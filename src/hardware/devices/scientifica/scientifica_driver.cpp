#include "hardware/devices/scientifica/scientifica_driver.h"

#include <cmath>
#include <regex>

#include "hardware/devices/scientifica/scientifica_protocol.h"

namespace microinjection {
namespace {

constexpr double kRounded = 0.02;  // of a setting

enum Step { kMaker, kVersion, kScaleX, kScaleY, kScaleZ, kAcceleration, kStartSpeed, kSteps };

PolledManipulator::Dialect dialect(const ScientificaConfig& config) {
  PolledManipulator::Dialect dialect;
  dialect.device = "Scientifica PatchStar (motion card " + std::to_string(config.version) + ")";
  dialect.short_name = "Scientifica";
  dialect.guarded_stop = "\rSTOP\r";  // ends an incomplete command first
  dialect.stop = "STOP";
  dialect.position = config.version == 2 ? "POS" : "P";
  dialect.motion = "S";
  dialect.longest_move = 60;  // TOP, its reading back, ABS, and their replies
  dialect.move_replies = 3;
  dialect.longest_reading = 36;  // includes S and its reply
  dialect.stop_duration = config.speed / config.acceleration;
  dialect.moved_by_hand = true;
  return dialect;
}

/// The card says the position of X as a whole number, when it has ended a line that was begun before at last.
bool isScientificaNumberLine(const std::string& answer) {
  static const std::regex form(R"((?:[\s\S]*\r)?-?\d+\r)");
  return std::regex_match(answer, form);
}

}  // namespace

ScientificaConfig ScientificaConfig::read(ConfigReader& reader) {
  ScientificaConfig config;
  config.readCommon(reader, 38400, {1e-6, 3.9e-3});
  reader.integer("version", config.version, Range::closed(2, 3));
  reader.number("acceleration", config.acceleration, Range::closed(0.0005, 0.039));
  const double least = config.speed / config.segment_time;
  if (config.acceleration < least) {
    reader.error("acceleration", "must be at least speed / segment_time = " + std::to_string(least) +
                                     " m/s^2: a short move would end before it has its speed");
  }
  return config;
}

ScientificaDriver::ScientificaDriver(const ScientificaConfig& config, std::unique_ptr<Wire> wire)
    : PolledManipulator(config, std::move(wire), dialect(config)), config_(config) {
  // None of its letters begins a command of a Sutter MP-285 or MPC-200.
  askFirst({"PX\r", isScientificaNumberLine, "a Scientifica", config.reply_timeout});
}

double ScientificaDriver::count() const { return scientificaCount(config_.version); }

/// A motor's step is 1/64 um, so the device cannot rest at every count of version 3.
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
      return scientificaRequestScale(config_.version, step - kScaleX);
    case kAcceleration:
      return "ACC " + std::to_string(scientificaAcceleration(config_.version, config_.acceleration));
    case kStartSpeed:
      return "FIRST " + std::to_string(scientificaTop(config_.version, scientificaSlowest(config_.version)));
    default:
      return "";
  }
}

std::string ScientificaDriver::handleSetup(int step, const std::string& reply) {
  const std::optional<double> number = readScientificaNumber(reply);
  switch (step) {
    case kMaker:
      return reply == "Y519" ? "" : "no card of Scientifica's";
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
      return reply == "A" ? "" : "refused";
  }
}

bool ScientificaDriver::isReadBack(int step) const { return step == kAcceleration || step == kStartSpeed; }

/// A setting is a word and a number; the word alone requests the number.
std::string ScientificaDriver::settingQuery(const std::string& setting) const {
  return setting.substr(0, setting.find(' '));
}

/// A card may round what it was told; a digit that the line has changed moves it by more, or does no harm.
bool ScientificaDriver::isKept(const std::string& setting, const std::string& reply) const {
  const std::optional<double> told = readScientificaNumber(reply);
  const std::optional<double> set = readScientificaNumber(setting.substr(setting.find(' ') + 1));
  return told && set && std::abs(*told - *set) <= kRounded * std::abs(*set);
}

std::optional<Eigen::Vector3d> ScientificaDriver::readPosition(const std::string& reply) {
  return readScientificaPosition(reply);
}

std::optional<bool> ScientificaDriver::readMotion(const std::string& reply) const {
  return readScientificaMotion(reply);
}

bool ScientificaDriver::acknowledges(const std::string& /*line*/, const std::string& reply) const {
  return reply == "A";
}

PolledManipulator::Plan ScientificaDriver::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                                                const Eigen::Vector3d& /*fastest*/) const {
  const int top = scientificaTop(config_.version, speed);
  const std::string move = scientificaGoTo({std::lround(to.x()), std::lround(to.y()), std::lround(to.z())});
  // A trapezoidal or triangular speed profile.
  const double distance = (to - from).norm() * count(), v = scientificaSpeed(config_.version, top);
  const double a = config_.acceleration;
  const double duration = distance > v * v / a ? distance / v + v / a : 2 * std::sqrt(distance / a);
  return {"TOP " + std::to_string(top), move, duration, v, 0};
}

}  // namespace microinjection
