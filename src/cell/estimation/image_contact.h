#pragma once

#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <optional>

#include "base/config_reader.h"

namespace microinjection {

struct ImageContactConfig {
  int images = 15;               ///< newest ones that count
  int least_images = 3;          ///< with fewer, nothing is known
  double shared_error = 0.2e-6;  ///< m, that all images share: outline, pixel size, plane in focus
  double largest_depth = 30e-6;  ///< m, of a dimple that counts, and of a gap above the cell

  void read(ConfigReader& reader);
};

/// The height of a cell's surface as images show it: the tip's height, and the gap from the outline to the
/// tip above the cell, or the depth of the dimple under it. It needs no force.
class ImageContact {
 public:
  struct Height {
    double value, deviation;  ///< m, of the surface above where it is modelled
  };

  /// `radius`: m, of the modelled cell about the origin.
  ImageContact(const ImageContactConfig& config, double radius);

  /// A tip in an image. `tip`: m, relative to the cell's centre, at the time of exposure, the needle
  /// along z; `depth`: m, along the needle, below the undisturbed outline, negative above it;
  /// `deviation`: m. Depths that are not finite, zero or too large do not count, nor does a tip beside
  /// the cell.
  void add(const Eigen::Vector3d& tip, double depth, double deviation);

  /// Median of the newest images.
  std::optional<Height> height() const;

 private:
  struct Seen {
    double height, deviation;  ///< m
  };
  ImageContactConfig config_;
  double radius_;  ///< m
  boost::circular_buffer<Seen> heights_;
};

}  // namespace microinjection
