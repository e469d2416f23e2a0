#include "operation/control/force_witness.h"

#include <algorithm>
#include <limits>
#include <sstream>

namespace microinjection {
namespace {

constexpr double kFallen = 0.9;  ///< of the largest force: a smaller one has fallen
constexpr int kLaterFelt = 200;  ///< steps, by which one force may tell a puncture before the other one

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
}

void ForceWitness::rearm() {
  monitor_.rearm();
  punctured_ = false;
  since_puncture_ = 0;
  largest_ = 0;
}

void ForceWitness::skip() { monitor_.skip(); }

void ForceWitness::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                        const std::optional<Eigen::Vector3d>& force, bool is_new) {
  tip_ = tip;
  axis_ = axis;
  heard_ = force && force->allFinite();
  if (!heard_) return monitor_.skip();
  if (!is_new) {
    since_puncture_ += punctured_;
    return monitor_.move(tip, axis);
  }
  monitor_.step(tip, axis, *force);
  if (monitor_.confirmed() && !*monitor_.confirmed()) rearm();  // it was noise
  if (!monitor_.touched()) return;
  punctured_ = punctured_ || monitor_.punctured();
  since_puncture_ += punctured_;
  largest_ = std::max(largest_, monitor_.force());
}

void ForceWitness::see(const NeedleMonitor& acting, const std::optional<Image>& image, double dt) {
  const bool deep = acting.touched() && acting.depthOf(tip_, axis_) > config_.depth;
  deep_ = deep ? deep_ + dt : 0;
  // An image from before shows another place.
  if (!image || image->age > deep_) return gap_.reset();
  gap_ = image->gap;
}

std::string ForceWitness::disagreement(const NeedleMonitor& acting) const {
  if (gap_ && *gap_ > config_.gap) {
    std::ostringstream text;
    text << (config_.measured ? "the prediction" : "the sensor") << " has felt a touch " << config_.depth
         << " m ago, the image shows the tip " << *gap_
         << " m before the cell; allowed is witness/gap = " << config_.gap << " m";
    return text.str();
  }
  if (!heard_ || !monitor_.ready() || !acting.ready() || !(acting.touched() || monitor_.touched())) return "";
  // A model whose membrane fails earlier than the real one says nothing of the sensor.
  if (punctured_)
    return config_.measured && since_puncture_ > kLaterFelt
               ? "the sensor has felt a puncture, the prediction has not: is the cell's puncture force too large?"
               : "";
  const bool acting_more = acting.touched() && (!monitor_.touched() || acting.force() >= monitor_.force());
  const NeedleMonitor &more = acting_more ? acting : monitor_, &less = acting_more ? monitor_ : acting;
  const std::string sensor = "the sensor", prediction = "the prediction";
  const std::string &one = acting_more == config_.measured ? prediction : sensor,
                    &other = acting_more == config_.measured ? sensor : prediction;
  std::ostringstream text;
  if (!less.touched()) {
    const double depth = more.depthOf(tip_, axis_);
    if (depth <= config_.depth && more.force() <= config_.force) return "";
    text << one << " has felt a touch " << depth << " m ago and " << more.force() << " N since, " << other
         << " none; allowed are witness/depth = " << config_.depth << " m and witness/force = " << config_.force
         << " N";
  } else if (less.depthOf(tip_, axis_) > config_.depth && more.force() > config_.force &&
             more.force() > config_.ratio * less.force()) {
    text << one << " feels " << more.force() << " N, " << other << ' ' << less.force()
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
