#include "hardware/devices/joint_axes.h"

namespace microinjection {

AxisOrder AxisOrder::read(ConfigReader& reader) {
  AxisOrder order;
  Eigen::Vector3d axes(1, 2, 3);
  reader.vector("axes", axes, Range::closed(1, 3));
  for (int i = 0; i < 3; ++i) {
    order.of_joint[i] = static_cast<int>(axes[i]) - 1;
    if (axes[i] != order.of_joint[i] + 1) reader.error("axes", "must be whole numbers");
    for (int j = 0; j < i; ++j) {
      if (order.of_joint[i] == order.of_joint[j]) reader.error("axes", "two joints have the same axis");
    }
  }
  return order;
}

JointAxes JointAxes::read(ConfigReader& reader) {
  JointAxes axes;
  reader.vector("directions", axes.directions, Range::closed(-1, 1), ConfigReader::kRequired);
  reader.vector("origin", axes.origin, Range::finite(), ConfigReader::kRequired);
  if (axes.directions.cwiseAbs() != Eigen::Vector3d::Ones()) reader.error("directions", "each must be 1 or -1");
  return axes;
}

}  // namespace microinjection
