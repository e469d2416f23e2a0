#pragma once

#include <string>

namespace microinjection {

/// Where a node of this node's name runs on the master, such as http://rig:41231/; empty: nowhere. ROS would end that
/// node when this one registers: of a second session on one master each node would end its namesake of the first one,
/// while that moves a needle. A namesake that is dead, frozen or about to end does not count. Call after ros::init and
/// before the first node handle; waits up to two seconds for a namesake that ends.
std::string livingNamesake();

}  // namespace microinjection
