#include "nodes/cell/dimple_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr std::size_t kPlaces = 400;        // 2 s of them: images come later than the needle's poses
constexpr double kSpacing = 0.005;          // s, between two places that are kept
constexpr double kFastest = 30e-6;          // m/s, of a needle whose place at the time of exposure is known
constexpr double kFarthest = 2 * kSpacing;  // s, from a place to the time of exposure
constexpr double kClearGap = 4;             // px

/// Of the tip below the undisturbed outline, px; negative above it.
struct Depth {
  double value, deviation;
};

/// By the dimple, or, above the cell, by the gap: a needle that nearly touches may already press.
std::optional<Depth> depthIn(const cell_microinjection::VisionState& message) {
  const auto& tip = message.injection_pipette;
  const auto& beside = message.indentation;
  if (message.cell.verdict != message.cell.FOUND) return std::nullopt;
  if (beside.verdict == beside.FOUND) return Depth{beside.depth, beside.deviation};
  if (tip.verdict != tip.FOUND || !(beside.gap > kClearGap)) return std::nullopt;
  const double x = std::cos(tip.direction), y = std::sin(tip.direction);
  const double along = x * x * tip.covariance[0] + 2 * x * y * tip.covariance[1] + y * y * tip.covariance[3];
  return Depth{-beside.gap, std::hypot(beside.displacement_deviation, std::sqrt(along))};
}

}  // namespace

DimpleReader::DimpleReader(Bus& bus, const ImageContactConfig& config)
    : config_(config), contact_(config, 1), places_(kPlaces) {
  using cell_microinjection::VisionState;
  states_ = subscribeGuarded(bus, "vision/state", 1, &DimpleReader::onState, this);
}

void DimpleReader::startCell(double radius) {
  contact_ = ImageContact(config_, radius);
  places_.clear();
  waiting_.reset();
}

void DimpleReader::follow(const ros::Time& stamp, const Eigen::Vector3d& tip, bool learns) {
  if (!places_.empty()) {
    const double since = secondsBetween(places_.back().stamp, stamp);
    if (since < 0) {  // time was set back
      places_.clear();
      waiting_.reset();
    }
    if (since >= 0 && since < kSpacing) return;
  }
  places_.push_back({stamp, tip, learns});
  if (waiting_ && waiting_->exposed <= stamp) add(*std::exchange(waiting_, std::nullopt));
}

void DimpleReader::onState(const cell_microinjection::VisionState& message) {
  const std::optional<Depth> depth = depthIn(message);
  if (!depth || !(message.pixel_size > 0)) return;
  const Observation observation{message.header.stamp, message.pixel_size * depth->value,
                                message.pixel_size * depth->deviation};
  if (places_.empty() || places_.back().stamp < observation.exposed) {
    waiting_ = observation;
  } else {
    add(observation);
  }
}

void DimpleReader::add(const Observation& observation) {
  const auto after =
      std::find_if(places_.begin(), places_.end(), [&](const Place& p) { return p.stamp >= observation.exposed; });
  if (after == places_.begin() || after == places_.end()) return;
  const Place &next = *after, &last = *(after - 1);
  const double step = secondsBetween(last.stamp, next.stamp);
  if (step > kFarthest || !next.learns || !last.learns || (next.tip - last.tip).norm() > kFastest * step) return;
  const double share = secondsBetween(last.stamp, observation.exposed) / step;
  contact_.add(last.tip + share * (next.tip - last.tip), observation.depth, observation.deviation);
}

}  // namespace microinjection
