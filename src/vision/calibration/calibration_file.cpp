#include "vision/calibration/calibration_file.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <locale>
#include <sstream>

#include "base/atomic_file.h"
#include "base/config_errors.h"
#include "base/config_reader.h"
#include "base/errors.h"
#include "base/paths.h"

namespace microinjection {
namespace {

// A covariance is written and read with rounding; its smallest eigenvalue may be this far below 0.
constexpr double kRounding = 1e-9;  ///< of the correlations
constexpr double kIntervalRounding = 1e-9;

template <typename Vector>
void writeList(std::ostream& out, const Vector& values) {
  out << '[';
  for (Eigen::Index i = 0; i < values.size(); ++i) out << (i > 0 ? ", " : "") << values[i];
  out << ']';
}

void writeParameters(std::ostream& out, const CameraCalibration& calibration) {
  out << "parameters:  # covariance: with the parameters in this order, in the product of the units\n";
  for (int i = 0; i < kCalibrationParameters; ++i) {
    const auto parameter = static_cast<CalibrationParameter>(i);
    const Interval interval = calibration.interval(parameter);
    out << "  " << kCalibrationNames[i].name << ":  # " << kCalibrationNames[i].unit << '\n';
    out << "    estimated: " << (calibration.estimated[i] ? "true" : "false") << '\n';
    out << "    value: " << calibration.value[i] << '\n';
    out << "    interval: [" << interval.low << ", " << interval.high << "]  # 95 %\n";
    out << "    covariance: ";
    writeList(out, calibration.covariance.row(i));
    out << '\n';
  }
}

void readParameters(ConfigReader& reader, CameraCalibration& calibration,
                    std::array<Interval, kCalibrationParameters>& intervals) {
  ConfigReader parameters = reader.section("parameters", ConfigReader::kRequired);
  for (int i = 0; i < kCalibrationParameters; ++i) {
    ConfigReader parameter = parameters.section(kCalibrationNames[i].name, ConfigReader::kRequired);
    const bool positive = i == kPixelSize || i == kAxisRatio;
    parameter.boolean("estimated", calibration.estimated[i], ConfigReader::kRequired);
    parameter.number("value", calibration.value[i], positive ? Range::positive() : Range::finite(),
                     ConfigReader::kRequired);
    Eigen::VectorXd interval(2), row(int{kCalibrationParameters});
    interval.setZero();
    row.setZero();
    parameter.vector("interval", interval, Range::finite(), ConfigReader::kRequired);
    parameter.vector("covariance", row, Range::finite(), ConfigReader::kRequired);
    intervals[i] = {interval[0], interval[1]};
    calibration.covariance.row(i) = row.transpose();
  }
}

/// Throws ConfigError for what single keys do not show.
void checkWhole(const std::string& name, const CameraCalibration& calibration,
                const std::array<Interval, kCalibrationParameters>& intervals) {
  ConfigErrors errors(name);
  const auto& covariance = calibration.covariance;
  bool good = covariance.isApprox(covariance.transpose(), kRounding) && (covariance.diagonal().array() >= 0).all();
  if (good) {
    const CalibrationVector<double> scale =
        covariance.diagonal().unaryExpr([](double v) { return v > 0 ? 1 / std::sqrt(v) : 1.0; });
    const Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
    good = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation).eigenvalues().minCoeff() > -kRounding;
  }
  if (!good) errors.add("parameters: the covariances must be symmetric and not negative");
  errors.throwAny();
  for (int i = 0; i < kCalibrationParameters; ++i) {
    const Interval expected = calibration.interval(static_cast<CalibrationParameter>(i));
    const double tolerance = kIntervalRounding * (std::abs(calibration.value[i]) + expected.half());
    if (std::abs(expected.low - intervals[i].low) <= tolerance &&
        std::abs(expected.high - intervals[i].high) <= tolerance) {
      continue;
    }
    errors.add(std::string("parameters/") + kCalibrationNames[i].name +
               "/interval: does not follow from value and covariance; the file was edited");
  }
  errors.throwAny();
}

void readTips(ConfigReader& reader, CameraCalibration& calibration) {
  for (ConfigReader& entry : reader.sections("tips", ConfigReader::kRequired)) {
    TipRecord tip;
    entry.text("date", tip.date, ConfigReader::kRequired);
    Eigen::VectorXd place = tip.place;
    entry.vector("place", place, Range::finite(), ConfigReader::kRequired);
    tip.place = place;
    if (!isDate(tip.date)) entry.error("date", "must be YYYY-MM-DDTHH:MM:SSZ");
    calibration.tips.push_back(tip);
  }
}

void readQuality(ConfigReader& reader, CameraCalibration& calibration) {
  constexpr auto kRequired = ConfigReader::kRequired;
  const Range count{1, 1e9, false, false}, any{0, 1e9, false, false};
  reader.integer("points", calibration.points, count, kRequired);
  reader.integer("focus_points", calibration.focus_points, any, kRequired);
  reader.integer("outliers", calibration.outliers, any, kRequired);
  reader.integer("freedom", calibration.freedom, count, kRequired);
  reader.integer("focus_freedom", calibration.focus_freedom, count, kRequired);
  reader.number("variance_factor", calibration.variance_factor, Range::nonNegative(), kRequired);
  reader.number("residual", calibration.residual, Range::nonNegative(), kRequired);
  reader.number("focus_residual", calibration.focus_residual, Range::nonNegative(), kRequired);
}

CameraCalibration readNode(const YAML::Node& node, const std::string& name) {
  constexpr auto kRequired = ConfigReader::kRequired;
  ConfigReader reader(node, name);
  CameraCalibration calibration;
  bool complete = false;
  Eigen::VectorXd origin = calibration.origin, reference = calibration.reference_pixel;
  reader.text("date", calibration.date, kRequired);
  if (!isDate(calibration.date)) reader.error("date", "must be YYYY-MM-DDTHH:MM:SSZ");
  reader.boolean("mirrored", calibration.mirrored, kRequired);
  reader.vector("origin", origin, Range::finite(), kRequired);
  reader.vector("reference_pixel", reference, Range::finite(), kRequired);
  const Range side = Range::closed(1, 65536);
  if (reader.has("width") || reader.has("height")) {
    reader.integer("width", calibration.image_size.x(), side, kRequired);
    reader.integer("height", calibration.image_size.y(), side, kRequired);
  }
  readQuality(reader, calibration);
  std::array<Interval, kCalibrationParameters> intervals;
  readParameters(reader, calibration, intervals);
  readTips(reader, calibration);
  reader.boolean("complete", complete, kRequired);
  if (!complete) reader.error("complete", "must be true, as the last key of a whole file");
  reader.finish();
  checkWhole(name, calibration, intervals);
  calibration.origin = origin;
  calibration.reference_pixel = reference;
  return calibration;
}

}  // namespace

std::string calibrationPath(const std::string& configured) {
  return configured.empty() ? userDataFile("calibration.yaml") : configured;
}

std::string toYaml(const CameraCalibration& calibration) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  out << "# Calibration of the camera against the micromanipulator; doc/design/calibration.md has the equations.\n";
  out << "date: \"" << calibration.date << "\"  # UTC\n";
  out << "mirrored: " << (calibration.mirrored ? "true" : "false") << '\n';
  out << "origin: ";
  writeList(out, calibration.origin);
  out << "  # m, place of the tip that is seen at (tip_u, tip_v)\nreference_pixel: ";
  writeList(out, calibration.reference_pixel);
  out << "  # px, of the tips below\n";
  if (!calibration.image_size.isZero())
    out << "width: " << calibration.image_size.x() << "  # px, of the images\nheight: " << calibration.image_size.y()
        << '\n';
  out << "points: " << calibration.points << "  # tips used\n";
  out << "focus_points: " << calibration.focus_points << "  # focus readings used\n";
  out << "outliers: " << calibration.outliers << "  # left out\n";
  out << "freedom: " << calibration.freedom << "  # degrees of freedom of the pixels' residuals\n";
  out << "focus_freedom: " << calibration.focus_freedom << '\n';
  out << "variance_factor: " << calibration.variance_factor << "  # of the residuals over the stated covariances\n";
  out << "residual: " << calibration.residual << "  # px rms of a coordinate\n";
  out << "focus_residual: " << calibration.focus_residual << "  # m rms\n";
  writeParameters(out, calibration);
  out << "tips:" << (calibration.tips.empty() ? " []" : "  # m, position (x, z) with the tip at the reference pixel")
      << '\n';
  for (const TipRecord& tip : calibration.tips) {
    out << "  - {date: \"" << tip.date << "\", place: ";
    writeList(out, tip.place);
    out << "}\n";
  }
  out << "complete: true\n";
  return out.str();
}

void writeCalibration(const std::string& path, const CameraCalibration& calibration) {
  writeFileAtomically(path, toYaml(calibration));
}

CameraCalibration readCalibration(const std::string& path) { return readNode(loadYamlMap(path), path); }

CameraCalibration calibrationFromYaml(const std::string& text, const std::string& origin) {
  YAML::Node node;
  try {
    node = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ConfigError(origin + ": " + error.what());
  }
  if (!node.IsMap()) throw ConfigError(origin + ": must be a map");
  return readNode(node, origin);
}

}  // namespace microinjection
