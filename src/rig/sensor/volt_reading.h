#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// A line of voltages as a measuring amplifier or a data logger sends it, e.g. "0.1234,-1.0021\r\n", and the force
/// that they mean: force = matrix (voltages - offset).
struct VoltReadingConfig {
  std::string separator = ",";    ///< of columns, one character
  std::string terminator = "\n";  ///< of lines
  int columns = 2;                ///< in a line
  int first = 0;                  ///< column of the first voltage, from 0; the others follow it
  int voltages = 2;               ///< n, how many are used
  int decimals = -1;              ///< digits behind the point that each voltage must have; -1: any number
  std::string checksum = "none";  ///< or nmea: the line ends with * and two hex digits, the XOR of what is before it
  Eigen::Vector2d voltage_range{-10, 10};                           ///< V, lowest and highest that the device can send
  Eigen::MatrixXd matrix = 1e-4 * Eigen::MatrixXd::Identity(2, 2);  ///< N/V, 2 x n; rows (axial, lateral)
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(2);                ///< V, n

  /// `matrix` and `offset` are needed: nobody can guess them. They are read for `voltages` of them, matrix by rows.
  static VoltReadingConfig read(ConfigReader& reader);
};

/// The voltages (V) of a line without its terminator; empty when the line is not exactly as described: number of
/// columns, plain decimal numbers, digits, range, checksum.
std::optional<Eigen::VectorXd> parseVoltages(const std::string& line, const VoltReadingConfig& config);

/// (axial, lateral) in N.
Eigen::Vector2d forceOfVoltages(const Eigen::VectorXd& voltages, const VoltReadingConfig& config);

}  // namespace microinjection
