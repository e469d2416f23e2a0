#pragma once

#include <geometry_msgs/Vector3.h>

#include <cstdint>
#include <vector>

#include "nodes/haptic/message_traits.h"

namespace microinjection {

/// geomagic_control/DeviceFeedback of ros_geomagic: force in N. Its driver reads lock[0] to lock[2]
/// without checking the length.
struct DeviceFeedback {
  geometry_msgs::Vector3 force;
  geometry_msgs::Vector3 position;
  std::vector<std::uint8_t> lock = {0, 0, 0};
};

}  // namespace microinjection

MICROINJECTION_FOREIGN_MESSAGE(microinjection::DeviceFeedback, FalseType, "geomagic_control/DeviceFeedback",
                               "94755b031db27fe99c2c235c0da9b072",
                               "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 position\nbool[] lock\n" +
                                   microinjection::containedDefinition<geometry_msgs::Vector3>(),
                               {
                                 stream.next(message.force);
                                 stream.next(message.position);
                                 stream.next(message.lock);
                               })
