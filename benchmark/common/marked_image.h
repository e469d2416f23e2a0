#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>
#include "vision/frame/contrast_mode.h"

namespace microinjection {

/// A place or a round thing that a person has read in an image.
struct ImageMark {
  std::string thing;     ///< tip, mouth, ooplasm, zona_inner, zona_outer or vesicle
  cv::Point2d place;     ///< px, centre of a round thing
  double diameter = 0;   ///< px, of the circle of the same area; 0: a place
  double tolerance = 0;  ///< px, standard deviation of the reading
  bool readable = true;  ///< false: it is there, and nobody must find it: far out of focus
  bool in_frame = true;  ///< the image shows its place
};

/// An image and what is true of it. Places are in px from the centre of the top-left pixel.
struct MarkedImage {
  std::string name;
  cv::Mat image;
  std::vector<ImageMark> marks;
  bool has_cell = false, has_needle = false, has_holding = false;
  ContrastMode contrast_mode = ContrastMode::kUnknown;
  double needle = 0;   ///< rad, from the tip towards the shaft, from x towards y
  double holding = 0;  ///< rad, from the mouth towards the shaft
  double scale = 1;    ///< px, for a pixel of the image as it was taken
};

}  // namespace microinjection
