#include "nodes/injection/witnesses.h"

#include <algorithm>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/force_topic.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kSettles = 8e-3;   ///< s after the news of a changed cell, within which its force arrives
constexpr double kSmallFall = 0.9;  ///< of the modulus: a smaller fall is no puncture; a twin changes it every 30 ms
constexpr double kCellTimeout = 1;  ///< s, of /cell/state, which is published slowly

}  // namespace

Witnesses::Witnesses(Bus& bus, const std::string& force_source, double timeout) : timeout_(timeout) {
  const bool predicted = force_source == "predicted";
  using geometry_msgs::WrenchStamped;
  force_topic_ = bus.subscribe<WrenchStamped>(forceTopic(predicted ? "measured" : "predicted"), 10,
                                              [this](const auto& delivery) { force_ = delivery.message; });
  using cell_microinjection::CellParameters;
  changes_ = bus.subscribe<CellParameters>(
      "cell/parameters", 10, [this](const auto& delivery) { receiveChange(*delivery.message, delivery.raw.received); });
  if (!predicted) return;
  using cell_microinjection::CellState;
  cell_ = bus.subscribe<CellState>("cell/state", 1, [this](const auto& delivery) {
    cell_received_ = delivery.raw.received;
    can_be_punctured_ = !delivery.message->layers.empty();
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

void Witnesses::fill(const Eigen::Isometry3d& needle, const ros::Time& now, InjectionController::Input& input) {
  const double age = force_ ? secondsBetween(force_->header.stamp, now) : timeout_ + 1;
  if (age >= 0 && age <= timeout_) input.witness = validForce(force_.get(), needle.linear());
  input.cell_changed = !changed_.isZero() && !isDue(changed_, now, kSettles);
  if (can_be_punctured_ && !isDue(cell_received_, now, kCellTimeout)) input.predicted_inside = inside_;
}

}  // namespace microinjection
