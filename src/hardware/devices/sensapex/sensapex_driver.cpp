#include "hardware/devices/sensapex/sensapex_driver.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "base/parse_number.h"
#include "hardware/devices/axis_speeds.h"
#include "hardware/devices/sensapex/sensapex_wire.h"
#include "hardware/serial/udp_wire.h"

namespace microinjection {
namespace {

constexpr double kNanometre = 1e-9, kMicrometre = 1e-6;  // m
constexpr double kFastestUmp = 5e-3;                     // m/s, of an axis; assumed
constexpr double kKept = 0.6;                            // counts, by which a position may tremble
constexpr double kFourthAxis = 1e3;                      // nm, by which the fourth axis may be elsewhere

PolledManipulator::Dialect dialect(const SensapexConfig& /*config*/) {
  PolledManipulator::Dialect dialect;
  dialect.device = "Sensapex uMp";
  dialect.short_name = "Sensapex";
  dialect.guarded_stop = "STOP\r";
  dialect.stop = "STOP";
  dialect.position = "POS";
  dialect.longest_move = 92;      // bytes of a go-to and its acknowledgement
  dialect.longest_reading = 52;   // bytes of a request and its response
  dialect.stop_duration = 20e-3;  // assumed
  dialect.moved_by_hand = true;   // by its touch screen and knobs
  return dialect;
}

/// um/s, from nm/s below 1 um/s on.
double speedThatIsTold(double speed) {
  return speed < 1 ? std::max(1.0, std::round(speed * 1e3)) * 1e-3 : std::round(speed);
}

std::string speedText(double speed) {
  return std::to_string(speed < 1 ? -std::lround(speed * 1e3) : std::lround(speed));
}

std::vector<double> numbersOf(const std::string& reply) {
  std::vector<double> numbers;
  std::istringstream words(reply);
  for (std::string word; words >> word;) {
    const auto number = parseNumber<double>(word);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace

SensapexConfig SensapexConfig::read(ConfigReader& reader) {
  SensapexConfig config;
  config.readCommon(reader, kBaud, {1e-9, kFastestUmp});
  reader.integer("device", config.device, Range::closed(1, 0xffff));
  reader.number("resolution", config.resolution, Range::closed(20e-9, 2e-6));
  if (config.port.path.compare(0, 4, "udp:") == 0 && !UdpAddress::parse(config.port.path)) {
    reader.error("port/path", "must be udp:ADDRESS:PORT with numbers, such as udp:169.254.10.1:55555");
  }
  return config;
}

SensapexDriver::SensapexDriver(const SensapexConfig& config, std::unique_ptr<Wire> wire)
    : PolledManipulator(config,
                        std::make_unique<SensapexWire>(std::move(wire), static_cast<std::uint16_t>(config.device)),
                        dialect(config)),
      resolution_(config.resolution) {}

/// From the last one on it is known whether the device was started meanwhile.
std::string SensapexDriver::setup(int step) const { return step == 0 ? "AXES" : step == 1 ? "WATCH" : ""; }

std::string SensapexDriver::handleSetup(int step, const std::string& reply) {
  if (step > 0) return reply == "kept" ? "" : "no connection";
  told_.reset();
  if (clearing()) fourth_.reset();  // wherever it is, from there on
  const auto axes = parseNumber<int>(reply);
  axes_ = axes ? static_cast<std::size_t>(std::max(0, *axes)) : 0;
  return axes_ == 3 || axes_ == 4 ? "" : "it has not three or four axes";
}

std::optional<Eigen::Vector3d> SensapexDriver::readPosition(const std::string& reply) {
  const std::vector<double> numbers = numbersOf(reply);  // nm
  if (numbers.size() != axes_) return std::nullopt;
  if (axes_ == 4) {
    if (!fourth_) fourth_ = numbers[3];
    if (std::abs(numbers[3] - *fourth_) > kFourthAxis) return std::nullopt;
  }
  Eigen::Vector3d position = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]) * kNanometre / count();
  for (int i = 0; i < 3; ++i) {
    const bool keeps = told_ && std::abs(position[i] - (*told_)[i]) <= kKept;
    position[i] = keeps ? (*told_)[i] : std::round(position[i]);
  }
  told_ = position;
  return position;
}

PolledManipulator::Plan SensapexDriver::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                                             const Eigen::Vector3d& fastest) const {
  const double counts = kMicrometre / count();  // of a micrometre
  const Eigen::Vector3d most = fastest.cwiseMin(kFastestUmp) / kMicrometre;
  const AxisSpeeds chosen = straightSpeeds((to - from) / counts, speed / kMicrometre,
                                           most.array().floor().max(most.array().min(1)), 1 / counts, speedThatIsTold);
  std::string line = "GOTO";
  for (int i = 0; i < 3; ++i) line += " " + std::to_string(std::lround(to[i] * count() / kNanometre));
  for (int i = 0; i < 3; ++i) line += " " + speedText(std::max(chosen.speeds[i], 1e-3));
  return {"", line, chosen.duration, chosen.speeds.norm() * kMicrometre, chosen.deviation * counts};
}

}  // namespace microinjection
