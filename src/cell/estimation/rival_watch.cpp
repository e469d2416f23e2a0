#include "cell/estimation/rival_watch.h"

#include <cmath>
#include <utility>

namespace microinjection {
namespace {

constexpr double kComparisonStep = 0.5e-6;    ///< m, from one comparison to the next
constexpr double kFirst = 2e-6;               ///< m: before it, the shape of the force is not known
constexpr double kNearAxis = 0.1;             ///< of the cell's radius
constexpr int kContradictingComparisons = 2;  ///< comparisons in a row

AxisShape shapeOf(const SurrogateData& cell, double modulus) {
  ForceField::Local local;
  cell.field.makeLocal(0, local);
  return AxisShape(
      [&](double depth) {
        Eigen::Matrix3d jacobian;
        return local.evaluate(-depth * Eigen::Vector3d::UnitZ(), jacobian).z() / modulus;
      },
      cell.range.axis_depth);
}

}  // namespace

RivalWatch::RivalWatch(const Scene& scene, const std::shared_ptr<const SurrogateData>& cell,
                       std::shared_ptr<const std::vector<RivalCell>> rivals, const Config& config)
    : radius_(scene.radius()), rivals_(std::move(rivals)), config_(config) {
  const MaterialConfig& material = scene.cell.material();
  if (!rivals_ || rivals_->empty() || !material.viscoelasticity.prony.empty()) return;
  estimated_ = EstimatedCell{shapeOf(*cell, material.young_modulus), cell->median_error};
}

void RivalWatch::reset() {
  compared_ = 0;
  contradictions_ = 0;
  better_.clear();
}

const std::string& RivalWatch::follow(const std::vector<SampleHistory::Sample>& samples, double noise,
                                      const Estimate& estimate) {
  if (!estimated_ || !better_.empty() || estimate.depth < kFirst || estimate.depth < compared_ + kComparisonStep) {
    return better_;
  }
  compared_ = estimate.depth;
  contradictions_ = compare(samples, noise, estimate) ? contradictions_ + 1 : 0;
  if (contradictions_ >= kContradictingComparisons) better_ = last_;
  return better_;
}

bool RivalWatch::compare(const std::vector<SampleHistory::Sample>& samples, double noise, const Estimate& estimate) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  AxisSamples path;
  path.time.resize(count);
  path.travel.resize(count);
  path.force.resize(count);
  path.deviation.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const SampleHistory::Sample& sample = samples[static_cast<std::size_t>(i)];
    if (sample.tip.head<2>().norm() > kNearAxis * radius_) return false;
    path.time[i] = sample.time;
    path.travel[i] = -sample.tip.z();
    path.force[i] = sample.force;
    path.deviation[i] = std::hypot(noise / std::sqrt(sample.readings), config_.sensor_floor);
  }
  ShapeFitConfig known;
  known.contact = -radius_;
  known.contact_deviation = config_.contact_deviation;
  known.offset_deviation = config_.offset_deviation;
  ShapeFit start;
  start.modulus = estimate.modulus;
  start.contact = -radius_ - estimate.contact;
  start.offset = estimate.offset;
  const RivalComparison compared = compareWithRivals(*estimated_, *rivals_, path, known, start);
  last_ = compared.best;
  return compared.contradicts();
}

}  // namespace microinjection
