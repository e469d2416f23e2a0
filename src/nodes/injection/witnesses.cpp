#include "nodes/injection/witnesses.h"

#include <algorithm>
#include <cmath>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/force_topic.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kSettles = 8e-3;  ///< s after the news of a changed cell, within which its force arrives
constexpr double kSmallFall =
    0.9;  ///< of the modulus: a smaller fall is no puncture; an estimator changes it every 30 ms
constexpr double kCellTimeout = 0.1;   ///< s, of /cell/contact
constexpr double kImageTimeout = 0.5;  ///< s, of /vision/state

std::string otherForce(const std::string& force_source) {
  return forceTopic(force_source == "predicted" ? "measured" : "predicted");
}

}  // namespace

Witnesses::Witnesses(Cycle& cycle, const std::string& force_source, double timeout, bool quiet_sensor)
    : bus_(cycle.bus()),
      force_(cycle.input<geometry_msgs::WrenchStamped>(otherForce(force_source), InputPhase::kSampled, timeout)),
      force_lives_(cycle, force_,
                   force_source == "predicted" ? sensorThatIs(quiet_sensor) : ForceLiveness::Source::kModel) {
  force_.optional = true;
  using cell_microinjection::CellParameters;
  changes_ = bus_.subscribe<CellParameters>(
      "cell/parameters", 10, [this](const auto& delivery) { receiveChange(*delivery.message, delivery.raw.received); });
  using cell_microinjection::VisionState;
  images_ = subscribeMeasured<VisionState>(bus_, "vision/state", 1,
                                           [this](const VisionState& message, const auto&) { receiveImage(message); });
  if (force_source != "predicted") return;
  using cell_microinjection::CellContact;
  cell_ = bus_.subscribe<CellContact>("cell/contact", 1, [this](const auto& delivery) {
    cell_received_ = delivery.raw.received;
    can_be_punctured_ = delivery.message->can_be_punctured;
    inside_ = delivery.message->inside;
  });
}

/// The height, too, changes slowly.
void Witnesses::receiveChange(const cell_microinjection::CellParameters& message, const ros::Time& received) {
  for (std::size_t i = 0; i < std::min(message.name.size(), message.value.size()); ++i) {
    if (message.name[i] == "height") continue;
    const bool is_modulus = message.name[i] == "young_modulus";
    if (is_modulus && message.value[i] >= kSmallFall * modulus_ && modulus_ > 0) {
      modulus_ = std::max(modulus_, message.value[i]);
      continue;
    }
    if (is_modulus) modulus_ = message.value[i];
    changed_ = received;
  }
}

/// Only what is sure counts, in an image whose scale is known.
void Witnesses::receiveImage(const cell_microinjection::VisionState& message) {
  image_ = Receipt(message.header.stamp, bus_.steady());
  exposed_ = message.header.stamp;
  gap_.reset();
  const bool sure = message.cell.verdict == message.cell.FOUND &&
                    message.injection_pipette.verdict == message.injection_pipette.FOUND;
  const double gap = message.pixel_size * message.indentation.gap;
  if (sure && message.pixel_size > 0 && std::isfinite(gap)) gap_ = gap;
}

std::string Witnesses::fault(const ros::Time& now) const {
  const std::string rivals = force_.rivals(now);
  if (!rivals.empty()) return force_.topic + " is sent by two nodes, " + rivals;
  return force_.repeats.empty() ? "" : force_.topic + " repeats " + force_.repeats;
}

void Witnesses::fill(const Eigen::Isometry3d& needle, const ros::Time& now, InjectionController::Input& input) {
  force_lives_.step(needle.translation());
  input.witness = validForce(force_.get(now), needle.linear());
  input.witness_is_new = force_.takeUpdates() != nullptr;
  input.witness_fault = fault(now);
  input.cell_changed = !changed_.isZero() && !isDue(changed_, now, kSettles);
  if (can_be_punctured_ && !isDue(cell_received_, now, kCellTimeout)) input.predicted_inside = inside_;
  if (gap_ && !image_.isOld(kImageTimeout, now, bus_.steady())) input.image = {secondsBetween(exposed_, now), *gap_};
}

}  // namespace microinjection
