#pragma once

#include <cell_microinjection/OperatingState.h>
#include <cell_microinjection/StringStamped.h>
#include <geometry_msgs/PoseStamped.h>

#include <Eigen/Geometry>
#include <QWidget>
#include <functional>
#include <memory>
#include <optional>

#include "operation/console/needle_steps.h"
#include "rviz/action_watch.h"
#include "rviz/jog_row.h"

namespace microinjection {

/// Moves the needle by steps along x, y and z of `world`, while the controller leaves it alone.
///
/// In:  needle/operating_state, calibration/calibrate/status
/// Out: needle/move_cp (PoseStamped); with STOP, needle/state_command (stop)
class NeedleBar : public QWidget {
 public:
  /// `newest`: gives the session at the moment of a press. `pose`: of the needle's tip in `world`, or nothing where it
  /// is old or not known.
  NeedleBar(std::function<SessionView()> newest, std::function<std::optional<Eigen::Isometry3d>()> pose,
            QWidget* parent = nullptr);
  ~NeedleBar() override;
  /// Connects to the needle: other consoles have no use for its messages.
  void start(Bus& bus);
  /// Shows the newest of the messages that were handled.
  void refresh(const SessionView& session);
  /// Stops the needle on its way of a step.
  void stop();

 private:
  NeedleView view();
  void press(std::size_t button);

  std::function<SessionView()> newest_;
  std::function<std::optional<Eigen::Isometry3d>()> pose_;
  JogRow* row_;
  NeedleView needle_;
  double sent_at_ = -1e9;  ///< s, sessionNow()
  Bus* bus_ = nullptr;     ///< null: not started
  Publisher<geometry_msgs::PoseStamped> moves_;
  Publisher<cell_microinjection::StringStamped> stops_;
  std::unique_ptr<ActionWatch> calibration_;
  Subscription states_;
};

}  // namespace microinjection
