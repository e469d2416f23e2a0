#include "surrogate/prepared_cell.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/cache_file.h"
#include "cell/converged_force.h"
#include "surrogate/energy_fit.h"

namespace microinjection {
namespace {

constexpr char kFit[] = " fit 2";     ///< to be changed with what is fitted, and how
constexpr double kSmall = 0.01;       ///< of the largest force: smaller ones are not judged
constexpr double kFinestSection = 1;  ///< level

/// Force of the section over that of the training's mesh at the depths of the straight ray on the axis.
struct AxisCorrection {
  std::vector<double> depths;  ///< m, ascending
  std::vector<double> factors;

  double at(double depth) const {
    const auto next = std::upper_bound(depths.begin(), depths.end(), depth);
    if (depths.empty()) return 1;
    if (next == depths.begin()) return factors.front();
    if (next == depths.end()) return factors.back();
    const auto i = static_cast<std::size_t>(next - depths.begin());
    const double share = (depth - depths[i - 1]) / (depths[i] - depths[i - 1]);
    return (1 - share) * factors[i - 1] + share * factors[i];
  }
};

AxisCorrection axisCorrection(const Scene& scene, const std::vector<TrainingSample>& samples) {
  std::vector<const TrainingSample*> on_axis;
  for (const TrainingSample& sample : samples) {
    const bool straight = sample.angle == 0 && sample.displacement.head<2>().isZero(0);
    if (straight && sample.force.z() > 0) on_axis.push_back(&sample);
  }
  Indenting indenting;
  for (const TrainingSample* sample : on_axis) indenting.depths.push_back(-sample->displacement.z());
  Scene axial = scene;
  axial.needle.offset.setZero();
  ConvergedForceConfig config;
  config.finest = kFinestSection;
  const std::vector<ForcePoint> points = ConvergedForce(axial, indenting, config).solve();
  AxisCorrection result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].converged) continue;
    result.depths.push_back(points[i].depth);
    result.factors.push_back(points[i].force.z() / on_axis[i]->force.z());
  }
  return result;
}

}  // namespace

PreparedCell PreparedCell::fit(const Scene& scene, const Preparation& preparation,
                               std::vector<TrainingSample> samples) {
  const AxisCorrection correction = axisCorrection(scene, samples);
  for (TrainingSample& sample : samples) {
    sample.force *= correction.at(std::hypot(sample.displacement.z(), sample.displacement.head<2>().norm()));
  }
  PreparedCell cell;
  cell.range = preparation.range;
  cell.energy = EnergyExpansion(preparation.scales, preparation.degrees);
  fitEnergy(cell.energy, samples);
  std::vector<double> errors = forceErrors(cell.energy, samples, kSmall);
  if (!errors.empty()) {
    std::sort(errors.begin(), errors.end());
    cell.median_error = errors[errors.size() / 2];
    cell.largest_error = errors.back();
  }
  std::vector<double> angles;
  for (const TrainingRay& ray : preparation.rays) angles.push_back(ray.angle);
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  std::vector<TrainingSurface> surfaces;
  for (double angle : angles) surfaces.push_back(trainingSurface(scene, angle, kTrainingLevel));
  cell.surface = SurfaceShape(preparation.scales, angles, surfaces, samples);
  return cell;
}

std::string preparedFolder(const Scene& scene, const Preparation& preparation) {
  const std::string cache = cacheDirectory("prepared");
  return cache.empty() ? "" : cache + "/" + contentHash(preparation.description(scene));
}

std::string preparedFile(const Scene& scene, const Preparation& preparation) {
  const std::string folder = preparedFolder(scene, preparation);
  return folder.empty() ? "" : folder + "/prepared.cell";
}

void PreparedCell::save(const Scene& scene, const std::string& path) const {
  ByteWriter writer;
  const EnergyScales& scales = energy.scales();
  const EnergyDegrees& degrees = energy.degrees();
  for (double x : {scales.angle, scales.lateral, scales.depth, scales.energy, median_error, largest_error}) {
    writer.number(x);
  }
  for (int x : {degrees.place, degrees.direction, degrees.distance}) writer.number<std::int32_t>(x);
  writer.array(energy.coefficients());
  surface.write(writer);
  writeCacheFile(path, Preparation::plan(scene, range).description(scene) + kFit, writer.bytes());
}

std::optional<PreparedCell> PreparedCell::load(const Scene& scene, const PreparationRange& range,
                                               const std::string& path) {
  const auto bytes = readCacheFile(path, Preparation::plan(scene, range).description(scene) + kFit);
  if (!bytes) return std::nullopt;
  ByteReader reader(*bytes);
  PreparedCell cell;
  cell.range = range;
  EnergyScales scales;
  EnergyDegrees degrees;
  for (double* x :
       {&scales.angle, &scales.lateral, &scales.depth, &scales.energy, &cell.median_error, &cell.largest_error}) {
    *x = reader.number<double>();
  }
  for (int* x : {&degrees.place, &degrees.direction, &degrees.distance}) *x = reader.number<std::int32_t>();
  cell.energy = EnergyExpansion(scales, degrees);
  Eigen::VectorXd coefficients;
  reader.array(coefficients);
  cell.energy.setCoefficients(coefficients);
  cell.surface = SurfaceShape::read(reader);
  return cell;
}

}  // namespace microinjection
