#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "hardware/sensor/volt_reading.h"
#include "hardware/serial/line_splitter.h"
#include "hardware/serial/wire.h"

namespace microinjection {

/// Driver of a force sensor that streams its voltages over a serial line. Opens the line, and
/// reopens it after a failure. Skips and counts lines that do not match the configured format.
class SerialForceSensor {
 public:
  SerialForceSensor(std::unique_ptr<Wire> wire, const VoltReadingConfig& config);

  /// Reads the received bytes without blocking. `time` in s.
  void step(double time);

  struct Reading {
    Eigen::Vector2d force;   ///< N, (axial, lateral)
    double time = 0;         ///< s, when its line was received
    bool saturated = false;  ///< a voltage is at the end of its range
  };
  /// The newest reading; empty before the first one and after the line failed.
  const std::optional<Reading>& reading() const { return reading_; }

  unsigned goodLines() const { return good_lines_; }
  unsigned badLines() const { return bad_lines_ + lines_.tooLong(); }
  /// The reason why the line is not open; empty when it is open.
  const std::string& errorText() const { return error_text_; }

 private:
  void parseLine(const std::string& line, double time);

  std::unique_ptr<Wire> wire_;
  VoltReadingConfig config_;
  LineSplitter lines_;
  std::optional<Reading> reading_;
  std::string error_text_ = "the line is not open yet";
  double last_attempt_ = -1e9;  ///< s, of the last attempt to open the line
  unsigned good_lines_ = 0;
  unsigned bad_lines_ = 0;
};

}  // namespace microinjection
