#pragma once

#include <cell_microinjection/MeasureCell.h>
#include <cell_microinjection/VisionState.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "nodes/imaging/served_cell.h"
#include "nodes/runtime/master_monitor.h"
#include "vision/measurement/cell_measurement.h"
#include "vision/measurement/vision_config.h"

namespace microinjection {

/// Finds cell and pipettes in the microscope's images.
///
/// In:  microscope/image_raw
/// Out: vision/state (VisionState), vision/image_overlay; the service vision/measure_cell
///      (MeasureCell)
///
/// Parameters: config/vision.yaml
///
/// An image that is too old, out of order or cannot be read is refused: it changes nothing and is
/// not answered. The service has its own thread, so that images are served while it waits for
/// cell_simulator.
class VisionNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  VisionNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    std::string scene;     ///< path of the session's scene; empty: none, measure_cell writes no scene
    std::string families;  ///< folder; empty: none
    VisionConfig vision;
  };
  static Parameters readParameters(const ros::NodeHandle& private_node);

  void onImage(const sensor_msgs::Image& message);
  std::string refusalOf(const sensor_msgs::Image& message, const ros::Time& now) const;
  void readPixelSize();
  void publish(const std_msgs::Header& header, const Frame& frame, double processing_time);
  bool measureCell(cell_microinjection::MeasureCell::Request& request,
                   cell_microinjection::MeasureCell::Response& response);
  CellMeasurement measure() const;  ///< throws ConfigError with the reason why there is none
  std::string serve(const CellMeasurement& cell);
  std::string familyOf(const CellMeasurement& cell) const;  ///< a line for the user
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Parameters parameters_;
  SpecimenTracker tracker_;
  ServedCell served_;
  MasterMonitor master_{true};
  image_transport::ImageTransport transport_;
  ros::Publisher state_;
  image_transport::Publisher overlay_;
  image_transport::Subscriber images_;
  std::vector<std::uint8_t> last_data_;  ///< of the last image: noise changes each one of a camera that lives
  ros::Time stamp_;                      ///< of the last accepted image
  mutable std::mutex mutex_;             ///< of what follows, which the service reads
  CellReadings readings_;
  bool pressed_ = false;      ///< by the needle, in the newest image
  ros::SteadyTime received_;  ///< last accepted image
  std::string refusal_;       ///< of the last image; empty: accepted

  double pixel_size_ = 0;  ///< m; 0: not known
  unsigned accepted_ = 0;  ///< since reported_
  double longest_ = 0;     ///< s of processor time, since reported_
  ros::SteadyTime reported_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer timer_;
  ros::CallbackQueue service_queue_;
  ros::ServiceServer measure_;
  ros::AsyncSpinner service_thread_;  ///< last member: starts after the others, and ends first
};

}  // namespace microinjection
