#include "cell/identification/tongue_identification.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <set>
#include <stdexcept>

#include "base/errors.h"
#include "cell/identification/natural_spline.h"
#include "cell/identification/record_columns.h"
#include "cell/model/converged_tongue.h"

namespace microinjection {
namespace {

/// Suctions over the modulus at which a shape is solved: dense where the lip's contact closes and the curve bends.
const std::vector<double>& solvedSuctions() {
  static const std::vector<double> suctions = {0,    0.001, 0.003, 0.006, 0.01, 0.02, 0.035, 0.05, 0.075, 0.1, 0.13,
                                               0.17, 0.22,  0.27,  0.33,  0.4,  0.5,  0.6,   0.75, 0.9,   1.1, 1.4};
  return suctions;
}

constexpr double kLevel = 0;           ///< of the mesh, see scene_mesh.h
constexpr double kShapeError = 0.002;  ///< of the lengths' rise on that mesh; assumed
constexpr std::size_t kFewestSamples = 4, kFewestPressures = 3, kFewestTested = 6;
constexpr double kSearched = 1e3;  ///< of the modulus, above the smallest that has all equilibria
constexpr int kGrid = 200;

/// Residuals (m) and what is fitted beside the modulus.
struct Misfit {
  double offset = 0, cost = 0;  ///< m, m^2
  Eigen::VectorXd residuals;
};

Misfit misfitOf(const TongueRecord& record, double radius, const TongueShape& shape, double modulus) {
  const auto count = static_cast<Eigen::Index>(record.length.size());
  Misfit misfit;
  misfit.residuals.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double suction = std::min(-record.pressure[i] / modulus, shape.strongest());
    misfit.residuals[i] = record.length[i] - radius * shape.length(suction);
  }
  misfit.offset = misfit.residuals.mean();
  misfit.residuals.array() -= misfit.offset;
  misfit.cost = misfit.residuals.squaredNorm();
  return misfit;
}

/// Deviation (m) of the residuals' noise by their second differences along the suction, which a smooth misfit hardly
/// has.
double scatterOf(const TongueRecord& record, const Eigen::VectorXd& residuals) {
  std::vector<Eigen::Index> order(record.pressure.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return record.pressure[a] > record.pressure[b]; });
  double sum = 0;
  for (std::size_t i = 1; i + 1 < order.size(); ++i) {
    const double bend = residuals[order[i - 1]] - 2 * residuals[order[i]] + residuals[order[i + 1]];
    sum += bend * bend / 6;
  }
  return std::sqrt(sum / static_cast<double>(order.size() - 2));
}

void check(const TongueRecord& record) {
  const std::set<double> pressures(record.pressure.begin(), record.pressure.end());
  if (record.pressure.size() < kFewestSamples || pressures.size() < kFewestPressures) {
    throw ConfigError("the record has " + std::to_string(record.pressure.size()) + " tongues at " +
                      std::to_string(pressures.size()) + " pressures: must be 4 or more, at 3 or more");
  }
  const auto [strong, weak] = std::minmax_element(record.pressure.begin(), record.pressure.end());
  const double longest = record.length[strong - record.pressure.begin()],
               shortest = record.length[weak - record.pressure.begin()];
  if (!(longest > shortest)) throw ConfigError("the tongue does not grow with the suction");
}

}  // namespace

TongueRecord readTongueRecord(const TextTable& table, const std::map<std::string, std::string>& columns) {
  TongueRecord record;
  record.notes = table.notes;
  const auto found = findRecordColumns(table, RecordKind::kTongue, columns, record.notes);
  const RecordColumn &pressure = found.at("pressure"), &tongue = found.at("tongue");
  bool above = false, below = false;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double p = pressure.unit * table.columns[pressure.index].values[i],
                 length = tongue.unit * table.columns[tongue.index].values[i];
    if (!std::isfinite(p) || !std::isfinite(length)) continue;
    above = above || p > 0;
    below = below || p < 0;
    record.pressure.push_back(-std::abs(p));
    record.length.push_back(length);
  }
  if (above && below)
    throw ConfigError(table.path + ": column '" + table.titles()[pressure.index] +
                      "': has pressures above and below 0: must be suctions only");
  if (above) record.notes.emplace_back("pressures above 0 are taken as suctions");
  if (record.pressure.size() < table.rows())
    record.notes.push_back(std::to_string(table.rows() - record.pressure.size()) +
                           " rows without numbers are left out");
  return record;
}

TongueShape::TongueShape(const Scene& scene) : error_(kShapeError) {
  for (const Scene::Layer& layer : scene.cell.layers) {
    if (layer.surface_tension > 0)
      throw ConfigError("surface_tension of layer " + layer.name +
                        ": must be 0: a modulus that is searched does not scale it");
  }
  if (scene.holding_pipette.mouth && scene.holding_pipette.mouth->contact.adhesion_energy > 0)
    throw ConfigError(
        "holding_pipette/mouth/contact/adhesion: must be left out: a modulus that is searched does not scale it");
  const std::vector<double> lengths = tongueCurve(scene, solvedSuctions(), kLevel);
  const auto count = static_cast<Eigen::Index>(lengths.size());
  if (count < 4) throw ConfigError("the cell has no equilibrium under any suction in the scene's mouth");
  suctions_ = Eigen::Map<const Eigen::VectorXd>(solvedSuctions().data(), count);
  lengths_ = Eigen::Map<const Eigen::VectorXd>(lengths.data(), count);
  curvature_ = naturalSplineCurvature(suctions_, lengths_);
}

TongueShape::TongueShape(const std::vector<double>& suctions, const std::vector<double>& lengths, double error)
    : error_(error) {
  const bool ascending = std::is_sorted(suctions.begin(), suctions.end(), [](double a, double b) { return a <= b; });
  if (suctions.size() < 4 || suctions.size() != lengths.size() || !ascending || suctions.front() != 0)
    throw std::invalid_argument("TongueShape: needs four or more suctions, ascending from 0, with lengths");
  const auto count = static_cast<Eigen::Index>(suctions.size());
  suctions_ = Eigen::Map<const Eigen::VectorXd>(suctions.data(), count);
  lengths_ = Eigen::Map<const Eigen::VectorXd>(lengths.data(), count);
  curvature_ = naturalSplineCurvature(suctions_, lengths_);
}

double TongueShape::length(double suction) const {
  return naturalSpline(suctions_, lengths_, curvature_, suction).value;
}

Identification identifyTongue(const TongueRecord& record, const Scene& scene, const TongueShape& shape) {
  check(record);
  const double strongest = -*std::min_element(record.pressure.begin(), record.pressure.end());
  // Below the first one the strongest suction has no equilibrium.
  const double lowest = std::log(strongest / shape.strongest()), highest = lowest + std::log(kSearched);
  const auto cost = [&](double logarithm) { return misfitOf(record, scene.radius(), shape, std::exp(logarithm)).cost; };
  int best = 0;
  const auto at = [&](int i) { return lowest + (highest - lowest) * i / kGrid; };
  for (int i = 1; i <= kGrid; ++i) {
    if (cost(at(i)) < cost(at(best))) best = i;
  }
  const auto [found, least] =
      boost::math::tools::brent_find_minima(cost, at(std::max(best - 1, 0)), at(std::min(best + 1, kGrid)), 26);
  const double free = static_cast<double>(record.length.size()) - 2;
  const double f = boost::math::quantile(boost::math::fisher_f(1, free), 0.95);
  // Lengths of a record without any noise still are rounded: without this floor their interval would have no width.
  const double floor = 1e-12 * scene.radius() * scene.radius();
  const double bound = least + std::max(least, floor * free) * f / free;
  const auto above = [&](double logarithm) { return cost(logarithm) - bound; };
  const auto border = [&](double end, bool& bounded) {
    bounded = above(end) > 0;
    if (!bounded) return end;
    std::uintmax_t most = 100;
    const auto [low, high] = boost::math::tools::toms748_solve(above, std::min(end, found), std::max(end, found),
                                                               boost::math::tools::eps_tolerance<double>(20), most);
    return (low + high) / 2;
  };
  bool bounded_below = true, bounded_above = true;
  const double low = border(lowest, bounded_below), high = border(highest, bounded_above);
  const Misfit misfit = misfitOf(record, scene.radius(), shape, std::exp(found));
  const double by_shape = 1.96 * shape.error(), count = free + 2, noise = std::sqrt(misfit.cost / free);
  const auto [shortest, longest] = std::minmax_element(record.length.begin(), record.length.end());

  Identification result;
  char text[200];
  std::snprintf(text, sizeof(text), "the scene's cell in its section, held by suction; %.0f tongues, noise %.3g um",
                count, 1e6 * noise);
  result.model = text;
  // The offset goes with the modulus: over the modulus' interval, with its own noise.
  const double spread = std::sqrt(f / count) * noise;
  const double at_low = misfitOf(record, scene.radius(), shape, std::exp(low)).offset,
               at_high = misfitOf(record, scene.radius(), shape, std::exp(high)).offset;
  result.estimates = {
      {"young_modulus", "Pa", std::exp(found), std::exp(low) * (1 - by_shape), std::exp(high) * (1 + by_shape),
       bounded_below, bounded_above},
      {"offset", "m", misfit.offset, std::min(at_low, at_high) - spread, std::max(at_low, at_high) + spread, true}};
  result.noise = noise;
  result.independent = count;
  result.size = *longest - *shortest;
  result.misfit = std::sqrt(misfit.cost / count);
  result.scatter = scatterOf(record, misfit.residuals);
  if (!bounded_below)
    result.warnings.emplace_back("of a softer cell the strongest suction is not solved: the interval ends there");
  if (record.length.size() < kFewestTested)
    result.warnings.emplace_back("fewer than 6 tongues: whether the cell follows the record is not tested");
  return result;
}

}  // namespace microinjection
