#include "hardware/sensor/serial_force_sensor.h"

#include <utility>

namespace microinjection {
namespace {

constexpr double kRetry = 1;               // s
constexpr std::size_t kLongestLine = 512;  // bytes

}  // namespace

SerialForceSensor::SerialForceSensor(std::unique_ptr<Wire> wire, const VoltReadingConfig& config)
    : wire_(std::move(wire)), config_(config), lines_(config.terminator, kLongestLine) {}

void SerialForceSensor::step(double time) {
  if (!wire_->isOpen()) {
    reading_.reset();
    if (error_text_.empty()) error_text_ = "the line broke";
    if (time - last_attempt_ < kRetry) return;
    last_attempt_ = time;
    error_text_ = wire_->open();
    if (!error_text_.empty()) return;
    lines_.clear(true);  // The first line may be incomplete and still look valid.
  }
  for (const std::string& line : lines_.feed(wire_->read(time))) parseLine(line, time);
}

void SerialForceSensor::parseLine(const std::string& line, double time) {
  const auto voltages = parseVoltages(line, config_);
  if (!voltages) {
    ++bad_lines_;
    return;
  }
  ++good_lines_;
  const Eigen::Vector2d& range = config_.voltage_range;
  const bool saturated = voltages->minCoeff() <= range[0] || voltages->maxCoeff() >= range[1];
  reading_ = Reading{forceOfVoltages(*voltages, config_), time, saturated};
}

}  // namespace microinjection
