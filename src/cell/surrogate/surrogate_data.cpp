#include "cell/surrogate/surrogate_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "cell/model/similarity.h"
#include "cell/surrogate/energy_fit.h"

namespace microinjection {
namespace {

constexpr char kFit[] = " fit 11";  ///< change it when the fit changes
constexpr double kSmall = 0.0025;   ///< over the largest force: smaller ones are excluded from the errors
constexpr double kRounding = 1e-9;  ///< relative, of a change of units
constexpr EnergyDegrees kDegrees{};

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
SurrogateData decode(const SurrogatePlan& plan, ByteReader& reader) {
  SurrogateData cell;
  cell.range = plan.range;
  EnergyScales scales;
  for (double* x : {&cell.range.axis_depth, &cell.range.depth, &cell.range.lateral, &scales.angle, &scales.length,
                    &scales.energy, &cell.median_error, &cell.common_error, &cell.largest_error}) {
    *x = reader.number<double>();
  }
  bool same = true;
  for (int x : {kDegrees.angle, kDegrees.direction, kDegrees.distance}) same &= reader.number<std::int32_t>() == x;
  const auto within = [](double reached, double planned) {
    return reached > 0 && reached <= (1 + kRounding) * planned;
  };
  if (!(within(cell.range.axis_depth, plan.range.axis_depth) && within(cell.range.depth, plan.range.depth) &&
        within(cell.range.lateral, plan.range.lateral))) {
    throw std::runtime_error("its range cannot be");
  }
  const auto equal = [](double a, double b) { return std::abs(a - b) <= kRounding * std::abs(b); };
  same &= equal(scales.angle, plan.scales.angle) && equal(scales.length, plan.scales.length) &&
          equal(scales.energy, plan.scales.energy);
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

SurrogateData SurrogateData::fit(const Scene& scene, const SurrogatePlan& plan,
                                 const std::vector<TrainingResult>& results) {
  std::vector<double> angles;
  for (const TrainingRay& ray : plan.rays) angles.push_back(ray.angle);
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  const TrainingSet all = TrainingSet::gather(scene, plan, results);
  SurrogateData cell = fitted(plan, all);
  cell.surface = SurfaceShape(cell.range, scene.radius(), angles, all.surfaces);
  return cell;
}

SurrogateData SurrogateData::fitForces(const Scene& scene, const SurrogatePlan& plan,
                                       const std::vector<TrainingResult>& results) {
  return fitted(plan, TrainingSet::gather(scene, plan, results));
}

SurrogateData SurrogateData::fitted(const SurrogatePlan& plan, const TrainingSet& all) {
  const std::vector<TrainingSample>& samples = all.forces;
  SurrogateData cell;
  cell.range = all.range;
  cell.energy = EnergyExpansion(plan.scales, kDegrees);
  fitEnergy(cell.energy, samples);
  cell.field = ForceField(plan.scales);
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
  return cell;
}

std::string surrogateFolder(const Scene& scene, const SurrogatePlan& plan) {
  const std::string cache = cacheDirectory("surrogates");
  return cache.empty() ? "" : cache + "/" + contentHash(plan.description(scene));
}

std::string surrogateFile(const Scene& scene, const SurrogatePlan& plan) {
  const std::string folder = surrogateFolder(scene, plan);
  return folder.empty() ? "" : folder + "/prepared.cell";
}

void SurrogateData::changeUnits(double length, double of_energy) {
  range = range.scaled(length);
  energy.changeUnits(length, of_energy);
  if (!field.empty()) field.changeUnits(length, of_energy);
  surface.changeUnit(length);
}

void SurrogateData::save(const Scene& scene, const SurrogateRange& planned, const std::string& path) const {
  const Similarity units = Similarity::of(scene);
  SurrogateData data = *this;
  data.changeUnits(1 / units.length, 1 / units.energy());
  ByteWriter writer;
  const EnergyScales& scales = data.energy.scales();
  for (double x : {data.range.axis_depth, data.range.depth, data.range.lateral, scales.angle, scales.length,
                   scales.energy, median_error, common_error, largest_error}) {
    writer.number(x);
  }
  for (int x : {kDegrees.angle, kDegrees.direction, kDegrees.distance}) writer.number<std::int32_t>(x);
  writer.array(data.energy.coefficients());
  writer.array(data.field.coefficients());
  data.surface.write(writer);
  writeCacheFile(path, SurrogatePlan::plan(scene, planned).description(scene) + kFit, writer.bytes());
}

CacheRead<SurrogateData> SurrogateData::load(const Scene& scene, const SurrogateRange& range, const std::string& path) {
  const Similarity units = Similarity::of(scene);
  const SurrogatePlan plan = SurrogatePlan::plan(withoutDimension(scene), range.scaled(1 / units.length));
  const CacheRead<std::string> read = readCacheFile(path, plan.description(withoutDimension(scene)) + kFit);
  if (!read) return read.failure<SurrogateData>();
  try {
    ByteReader reader(*read.content);
    SurrogateData cell = decode(plan, reader);
    if (!reader.atEnd()) throw std::runtime_error("there is more than was written");
    cell.changeUnits(units.length, units.energy());
    return {std::move(cell), CacheState::kRead, ""};
  } catch (const std::exception& error) {  // an expansion throws std::invalid_argument
    return damagedCache<SurrogateData>(path, error.what());
  }
}

}  // namespace microinjection
