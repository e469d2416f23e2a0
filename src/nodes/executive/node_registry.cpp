#include "nodes/executive/node_registry.h"

#include <map>

#include "base/errors.h"
#include "nodes/calibration_node.h"
#include "nodes/camera_node.h"
#include "nodes/cell_estimator_node.h"
#include "nodes/cell_simulator_node.h"
#include "nodes/display_node.h"
#include "nodes/focus_node.h"
#include "nodes/force_sensor_node.h"
#include "nodes/force_watchdog_node.h"
#include "nodes/haptic/haptic_device_node.h"
#include "nodes/haptic_bridge_node.h"
#include "nodes/holder_node.h"
#include "nodes/image_recorder_node.h"
#include "nodes/injection_controller_node.h"
#include "nodes/injector_node.h"
#include "nodes/link_emulator_node.h"
#include "nodes/micromanipulator_node.h"
#include "nodes/microscope_node.h"
#include "nodes/needle/rig_frames_node.h"
#include "nodes/notebook_node.h"
#include "nodes/readiness_node.h"
#include "nodes/session_recorder_node.h"
#include "nodes/teleoperation_follower_node.h"
#include "nodes/touch_node.h"
#include "nodes/virtual_hand_node.h"
#include "nodes/vision_node.h"
#include "nodes/visual_servo_node.h"

namespace microinjection {

NodeFactory nodeFactory(const std::string& program) {
  static const std::map<std::string, NodeFactory> factories{
      {"calibration", makeNode<CalibrationNode>()},
      {"camera", makeNode<CameraNode>()},
      {"cell_estimator", makeNode<CellEstimatorNode>()},
      {"cell_simulator", makeNode<CellSimulatorNode>()},
      {"display", makeNode<DisplayNode>()},
      {"focus", makeNode<FocusNode>()},
      {"force_sensor", makeNode<ForceSensorNode>()},
      {"force_watchdog", makeNode<ForceWatchdogNode>()},
      {"haptic_bridge", makeNode<HapticBridgeNode>()},
      {"haptic_device", makeNode<HapticDeviceNode>()},
      {"holder", makeNode<HolderNode>()},
      {"image_recorder", makeNode<ImageRecorderNode>()},
      {"injection_controller", makeNode<InjectionControllerNode>()},
      {"injector", makeNode<InjectorNode>()},
      {"link_emulator", makeNode<LinkEmulatorNode>()},
      {"micromanipulator", makeNode<MicromanipulatorNode>()},
      {"microscope", makeNode<MicroscopeNode>()},
      {"notebook", makeNode<NotebookNode>()},
      {"virtual_hand", makeNode<VirtualHandNode>()},
      {"readiness", makeNode<ReadinessNode>()},
      {"rig_frames", makeNode<RigFramesNode>()},
      {"session_recorder", makeNode<SessionRecorderNode>()},
      {"teleoperation_follower", makeNode<TeleoperationFollowerNode>()},
      {"touch", makeNode<TouchNode>()},
      {"vision", makeNode<VisionNode>()},
      {"visual_servo", makeNode<VisualServoNode>()},
  };
  const auto found = factories.find(program);
  if (found == factories.end()) throw ConfigError("there is no node " + program + " that runs in virtual time");
  return found->second;
}

}  // namespace microinjection
