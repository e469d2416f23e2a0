// The virtual force sensor, estimated from its stream of readings, beside its configuration.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "benchmark/bench_main.h"
#include "benchmark/common/stream_estimates.h"
#include "hardware/sensor/force_sensor.h"

namespace microinjection {
namespace {

constexpr const char* kAxes[] = {"axial", "lateral"};

class SensorTable {
 public:
  explicit SensorTable(const ForceSensorConfig& config) : config_(config), period_(1 / config.sample_rate) {}

  std::string rows() {
    add("quantity,configured,estimated,unit\n");
    for (int axis = 0; axis < 2; ++axis) noise(axis);
    for (int axis = 0; axis < 2; ++axis) response(axis);
    coupling();
    for (int axis = 0; axis < 2; ++axis) saturation(axis);
    drift();
    return table_;
  }

 private:
  void add(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    table_ += text;
  }
  void row(const std::string& quantity, double configured, double estimated, const char* unit) {
    char text[160];
    std::snprintf(text, sizeof text, "%s,%.5g,%.5g,%s\n", quantity.c_str(), configured, estimated, unit);
    add(text);
  }

  Eigen::VectorXd stream(ForceSensor& sensor, int axis, const Eigen::Vector2d& force, int count) const {
    Eigen::VectorXd readings(count);
    for (double& reading : readings) reading = sensor.sample(force, period_)[axis];
    return readings;
  }
  static Eigen::Vector2d along(int axis, double force) { return force * Eigen::Vector2d::Unit(axis); }

  /// 40 s at rest. What the converter's rounding adds is taken off, as its step is in the stream,
  /// too.
  void noise(int axis) {
    ForceSensor sensor(config_);
    const double rate = config_.sample_rate;
    const Eigen::VectorXd readings = stream(sensor, axis, {0, 0}, static_cast<int>(40 * rate));
    const double step = quantisationStep(readings);
    const double rounding = roundingDensity(step, rate);
    // Drift is far below the white noise from a hundredth of the rate on.
    const double seen = noiseDensity(readings, rate, 4096, rate / 100, 0.48 * rate);
    density_[axis] = std::sqrt(std::max(0.0, seen * seen - rounding * rounding));
    row(kAxes[axis] + std::string(" noise density"), config_.density[axis], density_[axis], "N/sqrt(Hz)");
    row(kAxes[axis] + std::string(" quantisation step"), 2 * config_.range[axis] / std::pow(2.0, config_.bits), step,
        "N");
  }

  /// Onto and off 45 % of the range, so that no overshoot saturates, thirty times; the mean of the
  /// responses.
  void response(int axis) {
    ForceSensor sensor(config_);
    constexpr int kSteps = 30;
    const int count = std::max(64, static_cast<int>(20 * config_.sample_rate / config_.natural_frequency));
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(count);
    for (int i = 0; i < kSteps; ++i) {
      mean += stream(sensor, axis, along(axis, 0.45 * config_.range[axis]), count) / kSteps;
      mean -= stream(sensor, axis, {0, 0}, count) / kSteps;
    }
    const SecondOrder found = secondOrderOfStep(mean, config_.sample_rate);
    row(kAxes[axis] + std::string(" natural frequency"), config_.natural_frequency, found.natural_frequency, "Hz");
    row(kAxes[axis] + std::string(" damping ratio"), config_.damping_ratio, found.damping_ratio, "1");
  }

  /// Readings under half of the range of each axis, with and against it in turn, so that drift
  /// drops out.
  void coupling() {
    for (int from = 0; from < 2; ++from) {
      for (int to = 0; to < 2; ++to) {
        ForceSensor sensor(config_);
        const double force = 0.5 * std::min(config_.range[from], config_.range[to]);
        const int count = static_cast<int>(0.1 * config_.sample_rate);
        double sum = 0;
        for (int i = 0; i < 20; ++i) {
          const double sign = i % 2 == 0 ? 1 : -1;
          sum += sign * stream(sensor, to, along(from, sign * force), count).tail(count / 2).mean();
        }
        const std::string name = std::string(kAxes[to]) + " reading of " + kAxes[from] + " force";
        row(name, config_.sensitivity(to, from), sum / 20 / force, "1");
      }
    }
  }

  /// A slow ramp to 1.2 times the range.
  void saturation(int axis) {
    ForceSensor sensor(config_);
    double most = 0;
    for (int i = 0; i <= 1000; ++i) {
      most = std::max(most, stream(sensor, axis, along(axis, 1.2e-3 * i * config_.range[axis]), 10).maxCoeff());
    }
    row(kAxes[axis] + std::string(" saturation"), config_.range[axis], most, "N");
  }

  /// Two hours at rest.
  void drift() {
    constexpr double kBlock = 4;  // s
    constexpr int kBlocks = 1800;
    ForceSensor sensor(config_);
    const int count = static_cast<int>(kBlock * config_.sample_rate);
    Eigen::Matrix2Xd means = Eigen::Matrix2Xd::Zero(2, kBlocks);
    for (int block = 0; block < kBlocks; ++block) {
      for (int i = 0; i < count; ++i) means.col(block) += sensor.sample({0, 0}, period_) / count;
    }
    for (int axis = 0; axis < 2; ++axis) {
      const DriftFigures found = driftOf(means.row(axis), kBlock, density_[axis]);
      row(kAxes[axis] + std::string(" drift rate"), config_.drift_rate[axis], found.rate, "N/s");
      row(kAxes[axis] + std::string(" random walk"), config_.random_walk[axis], found.random_walk, "N/sqrt(s)");
    }
  }

  ForceSensorConfig config_;
  double period_;                                      // s
  Eigen::Vector2d density_ = Eigen::Vector2d::Zero();  // N/sqrt(Hz), estimated
  std::string table_;
};

std::string sensorTable(const std::string& path) {
  ForceSensorConfig config;
  if (!path.empty()) {
    ConfigReader reader(loadYamlMap(path)["simulated"], path);
    config = ForceSensorConfig::read(reader);
    reader.finish();
  }
  return SensorTable(config).rows();
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string path = MICROINJECTION_SOURCE_DIR "/config/force_sensor.yaml";
  po::options_description more("Of the sensor");
  more.add_options()("config", po::value(&path),
                     "YAML file with the sensor's configuration (default: the suite's own)");
  return microinjection::benchMain(
      argc, argv, "The virtual force sensor, estimated from its stream of readings.",
      [&] { return microinjection::sensorTable(path); }, more);
}
