#include "operation/control/force_witness.h"

#include <algorithm>
#include <limits>
#include <sstream>

namespace microinjection {
namespace {

constexpr double kFallen = 0.9;         ///< of the largest force: a smaller one has fallen
constexpr long kCompared = 32;          ///< steps, over which forces are averaged
constexpr std::size_t kLeastPairs = 4;  ///< of a slow sensor, that are averaged
constexpr int kLaterFelt = 200;         ///< steps, by which one force may tell a puncture before the other one

}  // namespace

void WitnessConfig::read(ConfigReader& reader) {
  reader.number("depth", depth, Range::positive());
  reader.number("force", force, Range::positive());
  reader.number("gap", gap, Range::positive());
  reader.number("ratio", ratio, Range{1, std::numeric_limits<double>::infinity(), true, true});
}

ForceWitness::ForceWitness(const DetectionConfig& detection, const WitnessConfig& config)
    : config_(config), monitor_(detection) {}

void ForceWitness::reset() {
  monitor_.reset();
  punctured_ = false;
  since_puncture_ = 0;
  largest_ = 0;
  forgetPairs();
}

void ForceWitness::rearm() {
  monitor_.rearm();
  punctured_ = false;
  since_puncture_ = 0;
  largest_ = 0;
  forgetPairs();
}

void ForceWitness::skip() {
  monitor_.skip();
  forgetPairs();
}

void ForceWitness::forgetPairs() {
  pairs_.clear();
  new_acting_ = new_witness_ = false;
  difference_.clear();
}

void ForceWitness::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                        const std::optional<Eigen::Vector3d>& force, bool is_new) {
  ++steps_;
  tip_ = tip;
  axis_ = axis;
  heard_ = force && force->allFinite();
  if (!heard_) return skip();
  if (!is_new) {
    since_puncture_ += punctured_;
    return monitor_.move(tip, axis);
  }
  axial_ = force->dot(axis);
  new_witness_ = true;
  monitor_.step(tip, axis, *force);
  if (monitor_.confirmed() && !*monitor_.confirmed()) rearm();  // it was noise
  if (!monitor_.touched()) return;
  punctured_ = punctured_ || monitor_.punctured();
  since_puncture_ += punctured_;
  largest_ = std::max(largest_, monitor_.force());
}

void ForceWitness::compare(const NeedleMonitor& acting, const Eigen::Vector3d& force, bool is_new) {
  new_acting_ = new_acting_ || is_new;
  if (!new_acting_ || !new_witness_ || !monitor_.ready() || !acting.ready()) return;
  new_acting_ = new_witness_ = false;
  while (pairs_.size() > kLeastPairs && steps_ - pairs_.front().step > kCompared) pairs_.pop_front();
  pairs_.push_back({steps_, force.dot(axis_) - acting.offset(), axial_ - monitor_.offset()});
  difference_ = differenceOf(acting);
}

ForceWitness::Pair ForceWitness::meanOfPairs() const {
  Pair sum{0, 0, 0};
  for (const Pair& pair : pairs_) sum = {pair.step, sum.acting + pair.acting, sum.witness + pair.witness};
  const auto count = static_cast<double>(pairs_.size());
  return {sum.step, sum.acting / count, sum.witness / count};
}

void ForceWitness::see(const NeedleMonitor& acting, const std::optional<Image>& image, double dt) {
  const bool deep = acting.touched() && acting.depthOf(tip_, axis_) > config_.depth;
  deep_ = deep ? deep_ + dt : 0;
  // An image from before shows another place.
  if (!image || image->age > deep_) return gap_.reset();
  gap_ = image->gap;
}

std::string ForceWitness::disagreement() const {
  if (gap_ && *gap_ > config_.gap) {
    std::ostringstream text;
    text << (config_.measured ? "the prediction" : "the sensor") << " has felt a touch " << config_.depth
         << " m ago, the image shows the tip " << *gap_
         << " m before the cell; allowed is witness/gap = " << config_.gap << " m";
    return text.str();
  }
  // A model whose membrane fails earlier than the real one says nothing of the sensor.
  if (heard_ && punctured_)
    return config_.measured && since_puncture_ > kLaterFelt
               ? "the sensor has felt a puncture, the prediction has not: is the cell's puncture force too large?"
               : "";
  return difference_;
}

std::string ForceWitness::differenceOf(const NeedleMonitor& acting) const {
  if (!acting.touched() && !monitor_.touched()) return "";
  const Pair force = meanOfPairs();
  const bool acting_more = acting.touched() && (!monitor_.touched() || force.acting >= force.witness);
  const NeedleMonitor &more = acting_more ? acting : monitor_, &less = acting_more ? monitor_ : acting;
  const double larger = acting_more ? force.acting : force.witness;
  const double smaller = acting_more ? force.witness : force.acting;
  const std::string sensor = "the sensor", prediction = "the prediction";
  const std::string &one = acting_more == config_.measured ? prediction : sensor,
                    &other = acting_more == config_.measured ? sensor : prediction;
  std::ostringstream text;
  if (!less.touched()) {
    const double depth = more.depthOf(tip_, axis_);
    if (depth <= config_.depth && larger <= config_.force) return "";
    text << one << " has felt a touch " << depth << " m ago and " << larger << " N since, " << other
         << " none; allowed are witness/depth = " << config_.depth << " m and witness/force = " << config_.force
         << " N";
  } else if (less.depthOf(tip_, axis_) > config_.depth && larger > config_.force && larger > config_.ratio * smaller) {
    text << one << " feels " << larger << " N, " << other << ' ' << smaller
         << " N; allowed is a ratio of witness/ratio = " << config_.ratio;
  }
  return text.str();
}

std::string ForceWitness::deniesPuncture() const {
  if (!config_.measured || !heard_ || !monitor_.touched() || punctured_) return "";
  const double force = monitor_.force();
  if (force <= kFallen * largest_) return "";
  std::ostringstream text;
  text << "the predicted force fell, but that of the sensor, " << force << " N, did not";
  return text.str();
}

}  // namespace microinjection
