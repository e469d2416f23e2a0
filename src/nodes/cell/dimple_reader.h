#pragma once

#include <cell_microinjection/VisionState.h>

#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <optional>

#include "cell/estimation/image_contact.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// Reads the gap between needle and cell, and the dimple under the needle, from /vision/state. An image
/// counts only when the cell is found in it, and the tip above it or the dimple; when its pixel size is
/// known, and the needle was slow and its place known at the time of exposure.
class DimpleReader {
 public:
  DimpleReader(Bus& bus, const ImageContactConfig& config);

  /// Another cell, or the needle has been clear of this one. `radius`: m.
  void startCell(double radius);
  /// A pose of the needle. `stamp`: its time; `tip`: m, relative to the cell's centre; `learns`: whether
  /// images of this time count.
  void follow(const ros::Time& stamp, const Eigen::Vector3d& tip, bool learns);
  std::optional<ImageContact::Height> height() const { return contact_.height(); }

 private:
  struct Place {
    ros::Time stamp;
    Eigen::Vector3d tip;  ///< m
    bool learns;
  };
  struct Observation {
    ros::Time exposed;
    double depth, deviation;  ///< m, of the tip below the undisturbed outline; negative above it
  };
  void onState(const cell_microinjection::VisionState& message);
  void add(const Observation& observation);

  ImageContactConfig config_;
  ImageContact contact_;
  boost::circular_buffer<Place> places_;
  std::optional<Observation> waiting_;  ///< of an image that came before a later place of the needle was known
  Subscription states_;
};

}  // namespace microinjection
