#pragma once

#include <cell_microinjection/FindFocusAction.h>
#include <cell_microinjection/VisionState.h>
#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/repetition.h"
#include "nodes/bus/goal_node.h"
#include "nodes/runtime/receipt.h"
#include "vision/measurement/focus_search.h"
#include "vision/measurement/sharpness.h"

namespace microinjection {

/// Finds the plane in which the tip is in focus, and moves the focus there.
///
/// In:  microscope/image_raw while a goal is active, vision/state, /focus/measured_js,
///      /needle/measured_cp
/// Out: /focus/move_jp while a goal is active; the action focus/find (FindFocus)
///
/// Parameters: config/focus.yaml
///
/// The sharpness is taken in one window in all planes, at the tip as it is seen at the start. In the
/// best plane the tip must be found; where the window was beside it, the planes are seen once more.
class FocusNode : public GoalNode<cell_microinjection::FindFocusAction> {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  explicit FocusNode(Bus& bus);

 private:
  struct Parameters {
    double image_timeout = 0.5;      ///< s
    double largest_motion = 0.5e-6;  ///< m, of the needle during the search
    int core = 3;                    ///< px, see TipInImage
    FocusSearchConfig search;

    static Parameters read(const Bus& bus);
  };
  struct Tip {
    double stamp = 0;  ///< s
    bool found = false;
    TipInImage window;
  };

  void begin(const Goal& goal) override;
  Result end(bool success) override;
  void step() override;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  void beginSearch(double start, const Tip& tip);
  void onImage(const sensor_msgs::Image& message);
  void onVision(const cell_microinjection::VisionState& message);
  void onFocus(const sensor_msgs::JointState& message);
  void onNeedle(const geometry_msgs::PoseStamped& message);
  Receipt receive(const ros::Time& stamp) const { return {stamp, bus_.steady()}; }
  bool isOld(const Receipt& receipt) const {
    return receipt.isOld(parameters_.image_timeout, bus_.now(), bus_.steady());
  }
  std::optional<double> position() const;
  void verify(double now);  ///< the tip in the best plane
  void move(double position);

  Parameters parameters_;
  std::unique_ptr<FocusSearch> search_;                      ///< null: no goal is active
  TipInImage window_;                                        ///< of the search
  double start_ = 0;                                         ///< m, position of the focus at the start of the goal
  bool repeated_ = false;                                    ///< the planes are seen for the second time
  std::optional<double> rough_;                              ///< m, plane about which the search begins again
  std::optional<double> verified_since_;                     ///< s, when the focus was in the best plane
  std::size_t planes_ = 0;                                   ///< of an earlier search of this goal
  std::optional<Eigen::Vector3d> needle_, needle_at_start_;  ///< m; none: not known
  Receipt needle_receipt_;

  std::optional<double> focus_;  ///< m
  Receipt focus_receipt_;
  std::optional<Tip> tip_;
  Receipt tip_receipt_;
  std::string tip_reason_ = "no image was received";
  std::optional<FocusSearch::Reading> reading_;
  Receipt reading_receipt_;
  /// px: of the image that vision/state is of, of the search's first one, and of the newest one.
  Eigen::Vector2i seen_size_ = Eigen::Vector2i::Zero(), first_size_ = seen_size_, size_ = seen_size_;
  std::string image_problem_;                      ///< why the newest image is not usable; empty: it is
  Repetition<std::vector<std::uint8_t>> data_{0};  ///< of the images that arrived: noise changes each

  Publisher<sensor_msgs::JointState> command_;
  Subscription images_;  ///< while a goal is active
  Subscription vision_, focus_state_, needle_state_;
};

}  // namespace microinjection
