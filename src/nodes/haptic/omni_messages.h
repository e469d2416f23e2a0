#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>
#include <std_msgs/Header.h>

#include <cstdint>

#include "nodes/haptic/message_traits.h"

namespace microinjection {

/// omni_msgs/OmniState of phantom_omni. By default its pose is in millimetres, despite the
/// definition's comment.
struct OmniState {
  std_msgs::Header header;
  std::uint8_t locked = false;
  std::uint8_t close_gripper = false;
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 current;
  geometry_msgs::Vector3 velocity;
};

/// omni_msgs/OmniFeedback: force in N.
struct OmniFeedback {
  geometry_msgs::Vector3 force;
  geometry_msgs::Vector3 position;
};

/// omni_msgs/OmniButtonEvent, published on change only.
struct OmniButtonEvent {
  std::int32_t grey_button = 0;
  std::int32_t white_button = 0;
};

}  // namespace microinjection

MICROINJECTION_FOREIGN_MESSAGE(microinjection::OmniState, TrueType, "omni_msgs/OmniState",
                               "89c2a741de66e9e904f59a02b171dd6e",
                               "std_msgs/Header header\nbool locked\nbool close_gripper\ngeometry_msgs/Pose pose\n"
                               "geometry_msgs/Vector3 current\ngeometry_msgs/Vector3 velocity\n" +
                                   microinjection::containedDefinition<std_msgs::Header>() +
                                   microinjection::containedDefinition<geometry_msgs::Pose>() +
                                   microinjection::containedDefinition<geometry_msgs::Vector3>(),
                               {
                                 stream.next(message.header);
                                 stream.next(message.locked);
                                 stream.next(message.close_gripper);
                                 stream.next(message.pose);
                                 stream.next(message.current);
                                 stream.next(message.velocity);
                               })
MICROINJECTION_FOREIGN_MESSAGE(microinjection::OmniFeedback, FalseType, "omni_msgs/OmniFeedback",
                               "e9083ac4fd95494e94fbb0c0f90b6c00",
                               "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 position\n" +
                                   microinjection::containedDefinition<geometry_msgs::Vector3>(),
                               {
                                 stream.next(message.force);
                                 stream.next(message.position);
                               })
MICROINJECTION_FOREIGN_MESSAGE(microinjection::OmniButtonEvent, FalseType, "omni_msgs/OmniButtonEvent",
                               "fb77877e6b639935c3360838062f05f0", "int32 grey_button\nint32 white_button\n", {
                                 stream.next(message.grey_button);
                                 stream.next(message.white_button);
                               })
