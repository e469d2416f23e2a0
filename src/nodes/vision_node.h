#pragma once

#include <cell_microinjection/InterfacePosition.h>
#include <cell_microinjection/MeasureCell.h>
#include <cell_microinjection/VisionState.h>
#include <sensor_msgs/Image.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "base/repetition.h"
#include "nodes/bus/diagnostics.h"
#include "nodes/imaging/served_cell.h"
#include "vision/measurement/cell_measurement.h"
#include "vision/measurement/vision_config.h"

namespace microinjection {

/// Finds cell and pipettes in the microscope's images.
///
/// In:  microscope/image_raw
/// Out: vision/state (VisionState), vision/image_overlay, /needle/interface (InterfacePosition, of an image that surely
///      shows what is in the needle, and whose scale is known); the service vision/measure_cell (MeasureCell)
///
/// Parameters: config/vision.yaml
///
/// An image that is too old, out of order or cannot be read is refused: it changes nothing and is
/// not answered. The service has its own thread on a RosBus, so that images are served while it waits
/// for cell_simulator.
class VisionNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  explicit VisionNode(Bus& bus);

 private:
  struct Parameters {
    std::string scene;     ///< path of the session's scene; empty: none, measure_cell writes no scene
    std::string families;  ///< folder; empty: none
    VisionConfig vision;

    static Parameters read(const Bus& bus);
  };

  void onImage(const sensor_msgs::Image& message);
  std::string refusalOf(const sensor_msgs::Image& message, const ros::Time& now);
  double processingTime() const;  ///< s of processor time; in virtual time s of that, since no machine may change it
  std::string refusal() const;    ///< of the last image; empty: accepted
  Eigen::Vector2i imageSize() const;  ///< px, of the last accepted image; 0: none
  void readPixelSize();
  void publish(const std_msgs::Header& header, const Frame& frame, double processing_time);
  void measureCell(const cell_microinjection::MeasureCell::Request& request,
                   cell_microinjection::MeasureCell::Response& response);
  CellMeasurement measure() const;  ///< throws ConfigError with the reason why there is none
  std::string serve(const CellMeasurement& cell);
  std::string familyOf(const CellMeasurement& cell) const;  ///< a line for the user
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Bus& bus_;
  Parameters parameters_;
  SpecimenTracker tracker_;
  ServedCell served_;
  Publisher<cell_microinjection::VisionState> state_;
  Publisher<cell_microinjection::InterfacePosition> interface_;
  Publisher<sensor_msgs::Image> overlay_;
  Subscription images_;
  Repetition<std::vector<std::uint8_t>> data_{0};  ///< of the images that arrived: noise changes each
  ros::Time stamp_;                                ///< of the last accepted image
  mutable std::mutex mutex_;                       ///< of what follows, which the service reads
  CellReadings readings_;
  Eigen::Vector2i image_size_ = Eigen::Vector2i::Zero();  ///< px, of the last accepted image
  bool pressed_ = false;                                  ///< by the needle, in the newest image
  ros::SteadyTime received_;                              ///< last accepted image
  std::string refusal_;                                   ///< of the last image; empty: accepted

  double pixel_size_ = 0;            ///< m; 0: not known
  std::string calibration_warning_;  ///< why the calibration is not that of these images, or may not be
  unsigned accepted_ = 0;            ///< since reported_
  double longest_ = 0;               ///< s of processor time, since reported_
  ros::SteadyTime reported_;
  Diagnostics diagnostics_;
  BusHandle timer_;
  BusHandle measure_;  ///< last member: its thread starts after the others, and it ends first
};

}  // namespace microinjection
