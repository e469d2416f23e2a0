#include "nodes/runtime/force_liveness.h"

#include "nodes/runtime/conversions.h"

namespace microinjection {

ForceLiveness::ForceLiveness(Cycle& cycle, Input<geometry_msgs::WrenchStamped>& port, Source source)
    : port_(port),
      readings_(source == Source::kSensor ? kReadings : std::numeric_limits<double>::infinity()),
      on_way_(source == Source::kModel ? kWay : kWayOfSensor) {
  port_.onMessage([this](const geometry_msgs::WrenchStamped& message, const ros::Time&) { receive(message); });
  if (source != Source::kModel) return;
  using cell_microinjection::CellContact;
  contact_ = cycle.bus().subscribe<CellContact>("cell/contact", 10, [this](const auto& delivery) {
    presses_ = delivery.message->in_contact && !delivery.message->inside;
  });
}

void ForceLiveness::receive(const geometry_msgs::WrenchStamped& message) {
  if (message.header.stamp.isZero()) {
    readings_.reset();
    on_way_.reset();
    return way_from_.reset();
  }
  const Eigen::Vector3d force = toVector(message.wrench.force);
  readings_.step(force, 1);
  // Only what arrives can repeat: a force that is late is judged by its age.
  if (on_way_.changes(force)) {
    way_from_ = tip_;
  } else if (tip_ && way_from_) {
    on_way_.exposeTo((*tip_ - *way_from_).norm());
  }
}

void ForceLiveness::step(const std::optional<Eigen::Vector3d>& tip, bool felt) {
  tip_ = presses_ || felt ? tip : std::nullopt;
  if (!tip_ && !on_way_.repeats()) way_from_.reset();
  if (tip_ && !way_from_) way_from_ = tip_;
  port_.repeats =
      readings_.repeats()
          ? "one reading, whose noise must change it, unless the sensor is saturated (or is sensor/quiet true?)"
      : on_way_.repeats() ? "one force, although the needle has moved in the cell"
                          : "";
}

}  // namespace microinjection
