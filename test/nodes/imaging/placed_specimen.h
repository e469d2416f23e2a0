#pragma once

#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cell_microinjection/CellContact.h"
#include "cell_microinjection/CellState.h"
#include "cell_microinjection/VisionState.h"
#include "virtual_session.h"
#include "vision/calibration/camera_calibration.h"

namespace microinjection {

/// A camera for the part of the picture that a test needs: rendering and detection cost time for each pixel.
struct SmallCamera {
  int width = 480, height = 496;         ///< px
  Eigen::Vector2d origin{239.5, 359.5};  ///< px, of the world's origin
  double pixel = 0.25e-6;                ///< m, as shipped

  /// Changes of the microscope's parameters. `rate`: images a second.
  std::string parameters(double rate, const std::string& more = "") const {
    std::ostringstream text;
    text << "{rate: " << rate << ", camera: {width: " << width << ", height: " << height << ", pixel_size: " << pixel
         << ", origin: [" << origin.x() << ", " << origin.y() << "]}" << (more.empty() ? "" : ", " + more) << "}";
    return text.str();
  }
  /// Its exact calibration, with the play of a rig (m).
  CameraCalibration calibration(double backlash = 0) const {
    CameraCalibration exact;
    exact.date = "2025-03-04T05:06:07Z";
    exact.image_size = {width, height};
    exact.value[kPixelSize] = pixel;
    exact.value[kAxisRatio] = 1;
    exact.value[kBacklashX] = exact.value[kBacklashZ] = backlash;
    exact.value[kTipU] = origin.x();
    exact.value[kTipV] = origin.y();
    for (const int parameter : {kPixelSize, kAngle, kSkew, kAxisRatio, kBacklashX, kBacklashZ, kTipU, kTipV})
      exact.estimated[static_cast<std::size_t>(parameter)] = true;
    exact.points = 32;
    exact.tips = {exact.tipRecord(exact.date)};
    return exact;
  }
  /// One that was made with images of four times as many pixels, before they were binned.
  CameraCalibration calibrationOfOthers(double backlash = 0) const {
    CameraCalibration others = calibration(backlash);
    others.image_size *= 2;
    return others;
  }
  /// px, of a place in the world (m)
  Eigen::Vector2d pixelOf(double x, double z) const { return origin + Eigen::Vector2d(x, -z) / pixel; }
};

/// The state of a round cell (m) in the frame cell.
inline cell_microinjection::CellState roundCell(double radius) {
  constexpr int kRings = 24, kSectors = 48;
  cell_microinjection::CellState state;
  state.header.frame_id = "cell";
  const auto add = [&](double polar, double turn) {
    geometry_msgs::Point32 vertex;
    vertex.x = static_cast<float>(radius * std::sin(polar) * std::cos(turn));
    vertex.y = static_cast<float>(radius * std::sin(polar) * std::sin(turn));
    vertex.z = static_cast<float>(radius * std::cos(polar));
    state.vertices.push_back(vertex);
  };
  add(0, 0);
  for (int ring = 1; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) add(M_PI * ring / kRings, 2 * M_PI * (sector + 0.5) / kSectors);
  }
  add(M_PI, 0);
  const auto vertex = [](int ring, int sector) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * kSectors + sector % kSectors);
  };
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    state.triangles.insert(state.triangles.end(), {a, b, c});
  };
  const auto last = static_cast<std::uint32_t>(state.vertices.size() - 1);
  for (int sector = 0; sector < kSectors; ++sector) {
    triangle(0, vertex(1, sector), vertex(1, sector + 1));
    triangle(last, vertex(kRings - 1, sector + 1), vertex(kRings - 1, sector));
    for (int ring = 1; ring < kRings - 1; ++ring) {
      triangle(vertex(ring, sector), vertex(ring + 1, sector), vertex(ring, sector + 1));
      triangle(vertex(ring, sector + 1), vertex(ring + 1, sector), vertex(ring + 1, sector + 1));
    }
  }
  state.displacement.assign(state.vertices.size(), 0);
  state.parameter_names = {"diameter"};
  state.parameter_values = {2 * radius};
  return state;
}

/// Puts the mouth of the holding pipette somewhere, its body below; in place of what the rig's description says.
inline void placeHolder(TestNode& node, const Eigen::Vector3d& mouth) {
  geometry_msgs::TransformStamped frame;
  frame.header.stamp = node.bus().now();
  frame.header.frame_id = "world";
  frame.child_frame_id = "holding_pipette";
  frame.transform.translation.x = mouth.x();
  frame.transform.translation.y = mouth.y();
  frame.transform.translation.z = mouth.z();
  frame.transform.rotation.x = 1;  // half a turn: its z points away from the cell
  tf2_msgs::TFMessage message;
  message.transforms = {frame};
  node.say("/tf_static", message, true);
}

/// A round cell, held from below, and a needle, which the test places under the microscope: it says what simulator and
/// rig would say.
class PlacedSpecimen {
 public:
  PlacedSpecimen(VirtualSession& session, double radius, Eigen::Vector3d place = {0, 0, 60e-6})
      : tip(std::move(place)), cell(roundCell(radius)) {
    constexpr double kPeriod = 0.02;  // s
    TestNode& node = session.addTestNode("specimen", kPeriod);
    placeHolder(node, {0, 0, -radius});
    node.repeat<geometry_msgs::PoseStamped>("/needle/measured_cp",
                                            [this] { return std::optional(poseMessage(tip.x(), tip.y(), tip.z())); });
    node.repeat<cell_microinjection::CellState>("/cell/state",
                                                [this] { return cell_is_silent ? std::nullopt : std::optional(cell); });
    node.repeat<cell_microinjection::CellContact>("/cell/contact", [this] {
      cell_microinjection::CellContact contact;
      contact.in_contact = cell.in_contact;
      contact.inside = cell.inside;
      return cell_is_silent ? std::nullopt : std::optional(contact);
    });
  }
  PlacedSpecimen(const PlacedSpecimen&) = delete;

  Eigen::Vector3d tip;  ///< m, world
  cell_microinjection::CellState cell;
  bool cell_is_silent = false;
};

/// What becomes of the microscope's images from now on.
inline void alterImages(VirtualSession& session, const std::function<void(sensor_msgs::Image& image)>& change) {
  session.executive().network().alter("/microscope/image_raw", [change](Passage passage) {
    const auto image =
        boost::make_shared<sensor_msgs::Image>(*boost::static_pointer_cast<const sensor_msgs::Image>(passage.message));
    change(*image);
    passage.message = image;
    return std::vector<Passage>{passage};
  });
}
/// The camera was cropped: they lack their last rows.
inline void cropImages(VirtualSession& session) {
  alterImages(session, [](sensor_msgs::Image& image) {
    image.height -= 40;
    image.data.resize(std::size_t{image.step} * image.height);
  });
}

/// The grey levels of an image of the virtual microscope, CV_8U; they are the message's.
inline cv::Mat greyLevels(const sensor_msgs::Image& image) {
  return cv::Mat(static_cast<int>(image.height), static_cast<int>(image.width), CV_8U,
                 const_cast<std::uint8_t*>(image.data.data()), image.step);
}

inline bool tipIsFound(const cell_microinjection::VisionState* state) {
  return state && state->injection_pipette.verdict == cell_microinjection::PipetteInImage::FOUND;
}
inline bool cellIsFound(const cell_microinjection::VisionState* state) {
  return state && state->cell.verdict == cell_microinjection::CellInImage::FOUND;
}
inline Eigen::Vector2d seenTip(const cell_microinjection::VisionState& state) {
  return {state.injection_pipette.x, state.injection_pipette.y};
}

}  // namespace microinjection
