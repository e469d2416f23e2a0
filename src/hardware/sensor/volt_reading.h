#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// Format of a line of voltages, as a measuring amplifier or data logger sends it, e.g.
/// "0.1234,-1.0021\r\n", and its conversion to a force: force = matrix (voltages - offset).
struct VoltReadingConfig {
  std::string separator = ",";    ///< of columns, one character
  std::string terminator = "\n";  ///< of lines
  int columns = 2;                ///< in a line
  int first = 0;                  ///< column of the first voltage, from 0; the others follow it
  int voltages = 2;               ///< n, number of voltages used
  int decimals = -1;              ///< decimals that each voltage must have; -1: any number
  std::string checksum = "none";  ///< or nmea: the line ends with * and two hex digits, the XOR of the bytes before it
  Eigen::Vector2d voltage_range{-10, 10};                           ///< V, lowest and highest that the device can send
  Eigen::MatrixXd matrix = 1e-4 * Eigen::MatrixXd::Identity(2, 2);  ///< N/V, 2 x n; rows (axial, lateral)
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(2);                ///< V, n

  /// `matrix` (by rows) and `offset` are required, since they have no sensible defaults. Their size
  /// follows `voltages`.
  static VoltReadingConfig read(ConfigReader& reader);
};

/// Parses the voltages (V) of a line without its terminator. Empty unless the line matches the
/// configuration exactly: number of columns, plain decimal numbers, decimals, range, checksum.
std::optional<Eigen::VectorXd> parseVoltages(const std::string& line, const VoltReadingConfig& config);

/// Returns the force (N), (axial, lateral).
Eigen::Vector2d forceOfVoltages(const Eigen::VectorXd& voltages, const VoltReadingConfig& config);

}  // namespace microinjection
