#include "nodes/injection/witnesses.h"

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/force_topic.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kSettles = 8e-3;   ///< s after the news of a changed cell, within which its force arrives
constexpr double kCellTimeout = 1;  ///< s, of /cell/state, which is published slowly

}  // namespace

Witnesses::Witnesses(Bus& bus, const std::string& force_source, double timeout) : timeout_(timeout) {
  const bool predicted = force_source == "predicted";
  using geometry_msgs::WrenchStamped;
  force_topic_ = bus.subscribe<WrenchStamped>(forceTopic(predicted ? "measured" : "predicted"), 10,
                                              [this](const auto& delivery) { force_ = delivery.message; });
  using cell_microinjection::CellParameters;
  changes_ = bus.subscribe<CellParameters>("cell/parameters", 10,
                                           [this](const auto& delivery) { changed_ = delivery.raw.received; });
  if (!predicted) return;
  using cell_microinjection::CellState;
  cell_ = bus.subscribe<CellState>("cell/state", 1, [this](const auto& delivery) {
    cell_received_ = delivery.raw.received;
    can_be_punctured_ = !delivery.message->layers.empty();
    inside_ = delivery.message->inside;
  });
}

void Witnesses::fill(const Eigen::Isometry3d& needle, const ros::Time& now, InjectionController::Input& input) {
  const double age = force_ ? secondsBetween(force_->header.stamp, now) : timeout_ + 1;
  if (age >= 0 && age <= timeout_) input.witness = validForce(force_.get(), needle.linear());
  input.cell_changed = !changed_.isZero() && !isDue(changed_, now, kSettles);
  if (can_be_punctured_ && !isDue(cell_received_, now, kCellTimeout)) input.predicted_inside = inside_;
}

}  // namespace microinjection
