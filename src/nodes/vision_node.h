#pragma once

#include <cell_microinjection/MeasureCell.h>
#include <cell_microinjection/VisionState.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>

#include <string>

#include "nodes/runtime/master_monitor.h"
#include "vision/detection/cell_size.h"
#include "vision/detection/specimen_tracker.h"

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
/// not answered.
class VisionNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  VisionNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    std::string scene;           ///< path of the session's scene; empty: none, measure_cell writes no scene
    std::string calibration;     ///< file, see calibrationPath()
    double pixel_size = 0;       ///< m of the specimen; 0: that of the calibration
    double image_timeout = 0.5;  ///< s
    bool overlay = true;
    int measured_images = 15;
    SpecimenTrackerConfig tracker;
  };
  static Parameters readParameters(const ros::NodeHandle& private_node);

  void onImage(const sensor_msgs::Image& message);
  std::string refusalOf(const sensor_msgs::Image& message, const ros::Time& now) const;
  void publish(const std_msgs::Header& header, const Frame& frame, double processing_time);
  bool measureCell(cell_microinjection::MeasureCell::Request& request,
                   cell_microinjection::MeasureCell::Response& response);
  double pixelSize() const;  ///< m; throws ConfigError when it is not known
  /// The sizes in metres; throws ConfigError with the reason why there are none.
  void fillSizes(cell_microinjection::MeasureCell::Response& response) const;
  void writeScene(const std::string& path, const cell_microinjection::MeasureCell::Response& size) const;
  std::string serve(const cell_microinjection::MeasureCell::Response& size);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Parameters parameters_;
  SpecimenTracker tracker_;
  CellSizeReadings readings_;
  MasterMonitor master_{true};
  image_transport::ImageTransport transport_;
  ros::Publisher state_;
  image_transport::Publisher overlay_;
  image_transport::Subscriber images_;
  ros::ServiceServer measure_;
  ros::ServiceClient cell_;
  ros::Time stamp_;           ///< of the last accepted image
  ros::SteadyTime received_;  ///< last accepted image
  std::string refusal_;       ///< of the last image; empty: accepted
  unsigned accepted_ = 0;     ///< since reported_
  double longest_ = 0;        ///< s of processor time, since reported_
  ros::SteadyTime reported_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer timer_;
};

}  // namespace microinjection
