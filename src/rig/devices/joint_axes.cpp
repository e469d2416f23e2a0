#include "rig/devices/joint_axes.h"

namespace microinjection {

JointAxes JointAxes::read(ConfigReader& reader) {
  JointAxes axes;
  reader.vector("directions", axes.directions, Range::closed(-1, 1), ConfigReader::kRequired);
  reader.vector("origin", axes.origin, Range::finite(), ConfigReader::kRequired);
  if (axes.directions.cwiseAbs() != Eigen::Vector3d::Ones()) reader.error("directions", "each must be 1 or -1");
  return axes;
}

}  // namespace microinjection
