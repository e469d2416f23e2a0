#include "hardware/sensor/sensor_calibration.h"

#include <Eigen/SVD>
#include <limits>
#include <locale>
#include <sstream>

#include "base/config_reader.h"

namespace microinjection {
namespace {

constexpr int kAxes = 2;                     // axial, lateral
constexpr double kLargestGain = 100;         // of a force's size, and its inverse the smallest
const Range kForces = Range::closed(-1, 1);  // N; far beyond any sensor at a pipette

template <typename Values>
void writeList(std::ostream& out, const Values& values) {
  out << '[';
  for (Eigen::Index i = 0; i < values.size(); ++i) out << (i > 0 ? ", " : "") << values[i];
  out << ']';
}

}  // namespace

std::string gainRefusal(const Eigen::MatrixXd& gain) {
  if (!gain.allFinite()) return "the gain that fits the points is not finite";
  const Eigen::VectorXd factors = Eigen::JacobiSVD<Eigen::MatrixXd>(gain).singularValues();
  if (factors.maxCoeff() <= kLargestGain && factors.minCoeff() >= 1 / kLargestGain) return "";
  std::ostringstream text;
  text << "the gain that fits the points changes forces by factors from " << factors.minCoeff() << " to "
       << factors.maxCoeff() << ", allowed [" << 1 / kLargestGain << ", " << kLargestGain << "]";
  return text.str();
}

std::string toYaml(const SensorCalibration& calibration) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "# Of the node force_sensor: force = gain (reading - tare), axes: axial, lateral. Delete it after a change of "
         "the\n"
         "# sensor or of its matrix and offset.\n";
  out << "tare: ";
  writeList(out, calibration.tare);
  const Eigen::MatrixXd by_columns = calibration.gain.transpose();
  out << "  # N\ngain: ";
  writeList(out, Eigen::Map<const Eigen::VectorXd>(by_columns.data(), by_columns.size()));
  out << "  # by rows\npoints: " << calibration.points << "\nresidual: " << calibration.residual
      << "  # N rms, of the points\ncomplete: true\n";
  return out.str();
}

SensorCalibration readSensorCalibration(const std::string& path) {
  ConfigReader reader(loadYamlMap(path), path);
  Eigen::VectorXd tare = Eigen::VectorXd::Zero(kAxes), gain = Eigen::VectorXd::Zero(kAxes * kAxes);
  SensorCalibration calibration;
  bool complete = false;
  reader.vector("tare", tare, kForces, ConfigReader::kRequired);
  reader.vector("gain", gain, Range::finite(), ConfigReader::kRequired);
  reader.integer("points", calibration.points, Range::nonNegative(), ConfigReader::kRequired);
  reader.number("residual", calibration.residual, Range::nonNegative(), ConfigReader::kRequired);
  reader.boolean("complete", complete, ConfigReader::kRequired);
  calibration.tare = tare;
  calibration.gain = Eigen::Map<const Eigen::Matrix<double, kAxes, kAxes, Eigen::RowMajor>>(gain.data());
  const std::string refusal = gainRefusal(calibration.gain);
  if (!refusal.empty()) reader.error("gain", refusal);
  if (!complete) reader.error("complete", "must be true");
  reader.finish();
  return calibration;
}

}  // namespace microinjection
