#include "cell/surrogate/surrogate_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "base/cache_file.h"
#include "cell/surrogate/axis_ray.h"
#include "cell/surrogate/energy_fit.h"
#include "cell/surrogate/mesh_correction.h"

namespace microinjection {
namespace {

constexpr char kFit[] = " fit 8";  ///< change it when the fit changes
constexpr double kSmall = 0.0025;  ///< over the largest force: smaller ones are excluded from the errors
constexpr EnergyDegrees kDegrees{};
constexpr int kDeepSamples = 14;  ///< on the axis, below the depth of the range elsewhere

bool straightOnAxis(const TrainingRay& ray) { return ray.angle == 0 && ray.target.head<2>().isZero(0); }

/// Samples to fit: `forces` as converged as possible, `surfaces` on the coarse mesh and, deep on
/// the axis, of the section.
struct Samples {
  std::vector<TrainingSample> forces, surfaces;
  double axis_depth = 0;  ///< m, reached on the axis

  void add(const TrainingSample& sample) {
    forces.push_back(sample);
    surfaces.push_back(sample);
  }
};

/// Adds the section's results, which are more accurate and deeper, for the straight path on the
/// axis.
void addAxis(const Scene& scene, const PreparationRange& range, const std::vector<TrainingSample>& coarse,
             const Eigen::VectorXd& surface, Samples& samples) {
  std::vector<double> depths;
  for (const TrainingSample& sample : coarse) depths.push_back(-sample.displacement.z());
  for (int i = 1; i <= kDeepSamples; ++i) {
    depths.push_back(range.depth + (range.axis_depth - range.depth) * i / kDeepSamples);
  }
  for (const TrainingSample& sample : solveAxis(scene, depths, surface)) {
    samples.add(sample);
    samples.axis_depth = -sample.displacement.z();
  }
}

Samples gather(const Scene& scene, const Preparation& preparation, const std::vector<TrainingResult>& results,
               const Eigen::VectorXd& surface_on_axis) {
  const std::vector<TrainingRay>& rays = preparation.rays;
  const auto better = betterForces(preparation.scales, rays, results);
  Samples samples;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].level != kCoarseLevel) continue;
    if (straightOnAxis(rays[i])) {
      addAxis(scene, preparation.range, results[i].samples, surface_on_axis, samples);
      continue;
    }
    samples.forces.insert(samples.forces.end(), better[i].begin(), better[i].end());
    samples.surfaces.insert(samples.surfaces.end(), results[i].samples.begin(), results[i].samples.end());
  }
  return samples;
}

/// Relative errors of a force (angle, displacement -> N), ascending, without samples of small
/// force.
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

Eigen::VectorXd readCoefficients(ByteReader& reader) {
  Eigen::VectorXd coefficients;
  reader.array(coefficients);
  if (!coefficients.allFinite()) throw std::runtime_error("a coefficient is not finite");
  return coefficients;
}

/// Throws std::runtime_error or std::invalid_argument when the data are not of a cell of the plan.
SurrogateData decode(const Preparation& plan, ByteReader& reader) {
  SurrogateData cell;
  cell.range = plan.range;
  double& reached = cell.range.axis_depth;
  EnergyScales scales;
  for (double* x : {&reached, &scales.angle, &scales.length, &scales.energy, &cell.median_error, &cell.common_error,
                    &cell.largest_error}) {
    *x = reader.number<double>();
  }
  bool same = true;
  for (int x : {kDegrees.angle, kDegrees.direction, kDegrees.distance}) same &= reader.number<std::int32_t>() == x;
  if (!(reached > 0 && reached <= plan.range.axis_depth)) throw std::runtime_error("its range cannot be");
  same &=
      scales.angle == plan.scales.angle && scales.length == plan.scales.length && scales.energy == plan.scales.energy;
  if (!same) throw std::runtime_error("its scales or degrees are not those of this cell");
  for (const double error : {cell.median_error, cell.common_error, cell.largest_error}) {
    if (!(std::isfinite(error) && error >= 0)) throw std::runtime_error("an error of the fit cannot be");
  }
  cell.energy = EnergyExpansion(scales, kDegrees);
  cell.energy.setCoefficients(readCoefficients(reader));
  cell.field = ForceField(scales);
  cell.field.setCoefficients(readCoefficients(reader));
  cell.surface = SurfaceShape::read(reader);
  return cell;
}

}  // namespace

SurrogateData SurrogateData::fit(const Scene& scene, const Preparation& preparation,
                                 const std::vector<TrainingResult>& results) {
  std::vector<double> angles;
  for (const TrainingRay& ray : preparation.rays) angles.push_back(ray.angle);
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  std::vector<TrainingSurface> surfaces;
  for (double angle : angles) surfaces.push_back(trainingSurface(scene, angle));

  const Samples all = gather(scene, preparation, results, surfaces.front().nodes);
  if (!(all.axis_depth > 0)) throw std::runtime_error("on the axis the cell's section has no solution at any depth");
  const std::vector<TrainingSample>& samples = all.forces;
  SurrogateData cell;
  cell.range = preparation.range;
  cell.range.axis_depth = all.axis_depth;  // the section may end earlier
  cell.energy = EnergyExpansion(preparation.scales, kDegrees);
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
  cell.surface = SurfaceShape(cell.range, angles, surfaces, all.surfaces);
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

void SurrogateData::save(const Scene& scene, const PreparationRange& planned, const std::string& path) const {
  ByteWriter writer;
  const EnergyScales& scales = energy.scales();
  for (double x :
       {range.axis_depth, scales.angle, scales.length, scales.energy, median_error, common_error, largest_error}) {
    writer.number(x);
  }
  for (int x : {kDegrees.angle, kDegrees.direction, kDegrees.distance}) writer.number<std::int32_t>(x);
  writer.array(energy.coefficients());
  writer.array(field.coefficients());
  surface.write(writer);
  writeCacheFile(path, Preparation::plan(scene, planned).description(scene) + kFit, writer.bytes());
}

CacheRead<SurrogateData> SurrogateData::load(const Scene& scene, const PreparationRange& range,
                                             const std::string& path) {
  const Preparation plan = Preparation::plan(scene, range);
  const CacheRead<std::string> read = readCacheFile(path, plan.description(scene) + kFit);
  if (!read) return read.failure<SurrogateData>();
  try {
    ByteReader reader(*read.content);
    SurrogateData cell = decode(plan, reader);
    if (!reader.atEnd()) throw std::runtime_error("there is more than was written");
    return {std::move(cell), CacheState::kRead, ""};
  } catch (const std::exception& error) {  // an expansion throws std::invalid_argument
    return damagedCache<SurrogateData>(path, error.what());
  }
}

}  // namespace microinjection
