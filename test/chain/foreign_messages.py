"""Messages of the haptic devices' own packages, made from their definitions: we do not depend on those packages.

The md5 sums come from genpy and thus from the definitions, not from our C++ structs.
"""

import genpy.dynamic

VECTOR = "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
POSE = ("MSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n" + "=" * 80 + "\n"
        "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + "=" * 80 + "\n"
        "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n")
HEADER = "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"


def _make(name, *texts):
    return genpy.dynamic.generate_dynamic(name, ("=" * 80 + "\n").join(texts))[name]


OmniState = _make("omni_msgs/OmniState", "std_msgs/Header header\nbool locked\nbool close_gripper\n"
                  "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 current\ngeometry_msgs/Vector3 velocity\n",
                  HEADER, POSE, VECTOR)
OmniFeedback = _make("omni_msgs/OmniFeedback", "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 position\n", VECTOR)
OmniButtonEvent = _make("omni_msgs/OmniButtonEvent", "int32 grey_button\nint32 white_button\n")
DeviceFeedback = _make("geomagic_control/DeviceFeedback",
                       "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 position\nbool[] lock\n", VECTOR)
