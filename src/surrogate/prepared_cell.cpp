#include "surrogate/prepared_cell.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "base/cache_file.h"
#include "surrogate/axis_ray.h"
#include "surrogate/energy_fit.h"

namespace microinjection {
namespace {

constexpr char kFit[] = " fit 5";  ///< to be changed with what is fitted, and how
constexpr double kSmall = 0.0025;  ///< of the largest force: smaller ones are not judged
constexpr int kDeepSamples = 14;   ///< on the axis, below the range of the rest

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

bool onAxis(const TrainingSample& sample) {
  return sample.angle == 0 && sample.displacement.head<2>().isZero(0) && sample.force.z() > 0;
}

/// Takes off what the training's mesh is wrong by on the axis, and adds what the section knows below.
void correct(const Scene& scene, const PreparationRange& range, const Eigen::VectorXd& surface,
             std::vector<TrainingSample>& samples) {
  std::vector<double> depths, forces;
  for (const TrainingSample& sample : samples) {
    if (!onAxis(sample)) continue;
    depths.push_back(-sample.displacement.z());
    forces.push_back(sample.force.z());
  }
  for (int i = 1; i <= kDeepSamples; ++i) {
    depths.push_back(range.depth + (range.axis_depth - range.depth) * i / kDeepSamples);
  }
  const std::vector<TrainingSample> axis = solveAxis(scene, depths, surface);
  AxisCorrection correction;
  for (std::size_t i = 0; i < std::min(axis.size(), forces.size()); ++i) {
    correction.depths.push_back(depths[i]);
    correction.factors.push_back(axis[i].force.z() / forces[i]);
  }
  for (TrainingSample& sample : samples) {
    sample.force *= correction.at(std::hypot(sample.displacement.z(), sample.displacement.head<2>().norm()));
  }
  if (axis.size() > forces.size()) samples.insert(samples.end(), axis.begin() + forces.size(), axis.end());
}

/// Relative errors of a force (angle, displacement -> N), ascending, of the samples whose force is not small.
template <typename Force>
std::vector<double> forceErrors(const std::vector<TrainingSample>& samples, const Force& force) {
  std::vector<double> errors;
  const double largest = largestForce(samples);
  for (const TrainingSample& sample : samples) {
    if (!(sample.force.norm() > kSmall * largest)) continue;
    errors.push_back((force(sample.angle, sample.displacement) - sample.force).norm() / sample.force.norm());
  }
  if (errors.empty()) throw std::invalid_argument("no training sample has a force");
  std::sort(errors.begin(), errors.end());
  return errors;
}

double median(const std::vector<double>& sorted) { return sorted[sorted.size() / 2]; }
double common(const std::vector<double>& sorted) { return sorted[sorted.size() * 9 / 10]; }

}  // namespace

PreparedCell PreparedCell::fit(const Scene& scene, const Preparation& preparation,
                               std::vector<TrainingSample> samples) {
  std::vector<double> angles;
  for (const TrainingRay& ray : preparation.rays) angles.push_back(ray.angle);
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  std::vector<TrainingSurface> surfaces;
  for (double angle : angles) surfaces.push_back(trainingSurface(scene, angle, kTrainingLevel));

  correct(scene, preparation.range, surfaces.front().nodes, samples);
  PreparedCell cell;
  cell.range = preparation.range;
  cell.energy = EnergyExpansion(preparation.scales, preparation.degrees);
  fitEnergy(cell.energy, samples);
  cell.field = ForceField(preparation.scales);
  cell.field.fit(samples);
  const std::vector<double> errors = forceErrors(samples, [&](double angle, const Eigen::Vector3d& u) {
    ForceField::Local local;
    cell.field.makeLocal(angle, local);
    Eigen::Matrix3d jacobian;
    return local.evaluate(u, jacobian);
  });
  cell.median_error = median(errors);
  cell.common_error = common(errors);
  cell.largest_error = errors.back();
  const std::vector<double> of_energy = forceErrors(samples, [&](double angle, const Eigen::Vector3d& u) {
    EnergyExpansion::Local local;
    cell.energy.makeLocal(angle, local);
    return Eigen::Vector3d(-local.evaluate(u).gradient);
  });
  cell.energy_median_error = median(of_energy);
  cell.energy_common_error = common(of_energy);
  cell.surface = SurfaceShape(preparation.range, angles, surfaces, samples);
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
  for (double x : {scales.angle, scales.length, scales.energy, median_error, common_error, largest_error}) {
    writer.number(x);
  }
  for (int x : {degrees.place, degrees.direction, degrees.distance}) writer.number<std::int32_t>(x);
  writer.array(energy.coefficients());
  writer.array(field.coefficients());
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
       {&scales.angle, &scales.length, &scales.energy, &cell.median_error, &cell.common_error, &cell.largest_error}) {
    *x = reader.number<double>();
  }
  for (int* x : {&degrees.place, &degrees.direction, &degrees.distance}) *x = reader.number<std::int32_t>();
  cell.energy = EnergyExpansion(scales, degrees);
  Eigen::VectorXd coefficients;
  reader.array(coefficients);
  cell.energy.setCoefficients(coefficients);
  reader.array(coefficients);
  cell.field = ForceField(scales);
  cell.field.setCoefficients(coefficients);
  cell.surface = SurfaceShape::read(reader);
  return cell;
}

}  // namespace microinjection
