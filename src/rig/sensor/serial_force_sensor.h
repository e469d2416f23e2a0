#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "rig/sensor/volt_reading.h"
#include "rig/serial/line_splitter.h"
#include "rig/serial/wire.h"

namespace microinjection {

/// A real force sensor that sends its voltages over a serial line without being asked. Opens the line, and again after
/// it broke; skips and counts lines that are not as described.
class SerialForceSensor {
 public:
  SerialForceSensor(std::unique_ptr<Wire> wire, const VoltReadingConfig& config);

  /// Reads what has come; never waits. `time` in s.
  void step(double time);

  struct Reading {
    Eigen::Vector2d force;   ///< N, (axial, lateral)
    double time = 0;         ///< s, when its line was read
    bool saturated = false;  ///< a voltage is at the end of its range
  };
  /// The newest; empty before the first and after the line broke.
  const std::optional<Reading>& reading() const { return reading_; }

  unsigned goodLines() const { return good_lines_; }
  unsigned badLines() const { return bad_lines_ + lines_.tooLong(); }
  /// Why the line is not open; empty when it is.
  const std::string& trouble() const { return trouble_; }

 private:
  void take(const std::string& line, double time);

  std::unique_ptr<Wire> wire_;
  VoltReadingConfig config_;
  LineSplitter lines_;
  std::optional<Reading> reading_;
  std::string trouble_ = "the line is not open yet";
  double tried_ = -1e9;  ///< s, when the line was last tried
  unsigned good_lines_ = 0;
  unsigned bad_lines_ = 0;
};

}  // namespace microinjection
