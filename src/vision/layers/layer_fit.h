#pragma once

#include <Eigen/Core>
#include <cmath>

#include "vision/frame/contrast_mode.h"
#include "vision/frame/ellipse.h"
#include "vision/frame/frame.h"

namespace microinjection {

/// The borders of a cell with a zona by one fit to all grey values about them, see LayerModel.
struct LayerFit {
  struct Border {
    Ellipse ellipse;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of centre x, centre y, mean diameter, px^2
    double line = 0;    ///< amplitude of its line or rim, of full scale: negative when dark
    double width = 0;   ///< px, of its line or rim
    double misfit = 0;  ///< of the contrast of its lines: what the model leaves in all directions alike, rms
    double deviation() const { return 0.5 * std::sqrt(covariance(2, 2)); }  ///< px, of the mean radius
  };
  bool valid = false;
  Border outer, inner, ooplasm;
  double used = 0;        ///< share of the directions that the model describes
  double blur = 0;        ///< px, standard deviation
  double inner_gain = 0;  ///< chi^2 that the inner border explains
  double rival = 0;       ///< share of it that another place explains too
};

/// First values of a fit: ellipses of outer border and ooplasm, px of the ooplasm's dark rim, and, when it
/// is known from the frame before, the thickness of the zona (px; 0: it is searched).
struct LayerGuess {
  Ellipse outer, ooplasm;
  double rim = 0, thickness = 0;
};

/// @param guess  with borders within about a rim of those in the frame
LayerFit fitLayers(const Frame& frame, const LayerGuess& guess, ContrastMode mode);

}  // namespace microinjection
