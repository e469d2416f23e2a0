#include "nodes/imaging/tip_watch.h"

#include <algorithm>
#include <cmath>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kResolution = 0.2e-6;  // m, within which a needle rests
// s of this node's running time, after which what simulator and controller said is not known any more.
constexpr double kSilent = 1;
constexpr double kStateForgotten =
    5;  // s, the same, of steady time: after this even a node that stood still knows nothing
constexpr double kAwakePeriod = 0.05;  // s, in which that time is counted

/// Empty, or why the tip is not above the cell: it must be farther out along the shaft than the cell reaches.
std::string besideCell(const cell_microinjection::CellInImage& cell, const cell_microinjection::PipetteInImage& tip) {
  if (cell.verdict == cell.NOT_FOUND) return "";
  const double above = (tip.x - cell.x) * std::cos(tip.direction) + (tip.y - cell.y) * std::sin(tip.direction);
  return above > cell.diameter / 2 ? "" : "the tip is beside the cell or in it, by the image";
}

}  // namespace

TipWatch::TipWatch(Bus& bus, double timeout) : bus_(bus), timeout_(timeout) {
  constexpr int kQueue = 1;
  using cell_microinjection::OperatingState;
  using cell_microinjection::VisionState;
  subscriptions_ = {subscribeMeasured(bus, "/needle/measured_cp", kQueue, &TipWatch::onNeedle, this),
                    subscribeMeasured(bus, "vision/state", kQueue, &TipWatch::onVision, this),
                    subscribeGuarded<OperatingState>(
                        bus, "/needle/operating_state", kQueue,
                        [this](const OperatingState& message, const std::string&) { needle_state_ = message; }),
                    subscribeGuarded<OperatingState>(
                        bus, "/controller/operating_state", kQueue,
                        [this](const OperatingState& message, const std::string&) { controller_state_ = message; }),
                    subscribeMeasured<cell_microinjection::CellContact>(
                        bus, "/cell/contact", kQueue,
                        [this](const cell_microinjection::CellContact& message, const std::string&) {
                          touches_ = message.in_contact || message.inside;
                          touch_heard_ = {awake_.seconds(), bus_.steady()};
                        }),
                    subscribeMeasured<cell_microinjection::InjectionStatus>(
                        bus, "/controller/injection_state", kQueue,
                        [this](const cell_microinjection::InjectionStatus& message, const std::string&) {
                          injects_ = message.state != "idle" && message.state != "approach" && message.state != "fault";
                          injection_heard_ = {awake_.seconds(), bus_.steady()};
                        })};
  timer_ = bus.timer(kAwakePeriod, [this] { awake_.step(bus_.steady()); });
}

std::string TipWatch::cellInTheWay() const {
  const auto silent = [&](const Heard& heard) {
    return heard.awake >= 0 &&
           (awake_.seconds() - heard.awake > kSilent || secondsBetween(heard.time, bus_.steady()) > kStateForgotten);
  };
  if (silent(injection_heard_)) return "/controller/injection_state is silent: the needle may be in the cell";
  if (silent(touch_heard_)) return "/cell/contact is silent: the needle may touch the cell";
  if (injects_) return "the needle is at the cell or in it, by the controller: withdraw it";
  if (touches_) return "the needle touches the cell, by cell_simulator: withdraw it";
  return beside_;
}

std::string TipWatch::cellOnTheWay(const Eigen::Vector2d& pixel) const {
  const std::optional<SeenTip> seen = tip();
  if (!cell_ || !seen) return "";
  const Eigen::Vector2d way = pixel - seen->pixel, from = cell_->centre - seen->pixel;
  const double share = way.squaredNorm() > 0 ? std::clamp(from.dot(way) / way.squaredNorm(), 0.0, 1.0) : 0;
  return (from - share * way).norm() > cell_->radius ? "" : "the straight way to the pixel is through the cell";
}

std::optional<Eigen::Vector3d> TipWatch::position() const {
  if (isOld(position_receipt_)) return std::nullopt;
  return position_;
}

std::optional<SeenTip> TipWatch::tip() const {
  if (isOld(tip_receipt_)) return std::nullopt;
  return tip_;
}

void TipWatch::onNeedle(const geometry_msgs::PoseStamped& message) {
  const std::optional<Eigen::Isometry3d> pose = validPose(&message);
  const bool followed = position().has_value();
  const Receipt receipt = receive(message.header.stamp);
  position_.reset();
  if (!pose || isOld(receipt)) return;
  position_ = pose->translation();
  orientation_ = Eigen::Quaterniond(pose->linear());
  position_receipt_ = receipt;
  if (followed && (*position_ - resting_place_).norm() <= kResolution) return;
  resting_place_ = *position_;
  rested_ = bus_.now().toSec();
  if (on_motion) on_motion(*position_, followed);
}

void TipWatch::onVision(const cell_microinjection::VisionState& message) {
  tip_.reset();
  tip_receipt_ = receive(message.header.stamp);
  const auto& tip = message.injection_pipette;
  const bool old = isOld(tip_receipt_);
  tip_reason_ = old ? "the image is old, or stamped ahead" : tip.reason;
  if (old) return;
  image_size_ = Eigen::Vector2i(static_cast<int>(message.width), static_cast<int>(message.height));
  // Beside a cell the tip is often uncertain. What was known stays until an image shows the needle again.
  if (tip.verdict != tip.NOT_FOUND) beside_ = besideCell(message.cell, tip);
  if (message.cell.verdict != message.cell.NOT_FOUND)
    cell_ = SeenCell{{message.cell.x, message.cell.y}, message.cell.diameter / 2};
  if (tip.verdict != tip.FOUND) return;
  SeenTip seen;
  seen.stamp = message.header.stamp.toSec();
  seen.pixel = {tip.x, tip.y};
  for (int i = 0; i < 4; ++i) seen.covariance(i / 2, i % 2) = tip.covariance[i];
  if (!seen.pixel.allFinite() || !seen.covariance.allFinite()) {
    tip_reason_ = "the tip's place is not finite";
    return;
  }
  tip_ = seen;
  if (on_tip) on_tip(seen);
}

}  // namespace microinjection
