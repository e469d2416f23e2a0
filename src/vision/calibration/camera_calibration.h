#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "vision/calibration/camera_model.h"
#include "vision/calibration/play.h"
#include "vision/calibration/statistics.h"
#include "vision/calibration/tip_history.h"

namespace microinjection {

/// Relation between the manipulator's position and the pixel at which the needle's tip is seen, as calibrate() fits
/// it. Pixels count from the centre of the top-left pixel, x right, y down. The manipulator's axes x and z lie in the
/// image plane, y along the microscope's axis.
///
///     motors (m) -- play --> place of the tip (m) --+--> pixel = (tip_u, tip_v) + J (place - origin)
///                                                   '--> best focus (m) = focus_zero + f . (place - origin)
///
///     J = (1 / s) R diag(mirrored ? -1 : 1, -1) W,  2 x 3, px/m          (camera_model.h)
///
/// A place of the tip is the position (m) of a manipulator without backlash (Play::tip). Backlash is part of the
/// model, and replayed over all moves, because a tip that came from the other side is beside its pixel by all of it:
/// with 2 um of backlash a calibrated needle lands within 0.03 um (95 % of the simulated sessions,
/// doc/design/calibration.md).
///
/// Any six numbers would do for J. It is made of a pixel size, an angle, a skew and a ratio, and of a drift for axis
/// y, because these can be judged: the wrong objective shows as a pixel size, the wrong axis as a skew, and
/// calibrate() refuses either by name (CalibrationLimits). The camera is affine: what a lens distorts appears in the
/// residual, which has a limit, too.
///
/// Each value has an interval. The covariance is that of least squares scaled by the residuals, and so does not rely
/// on the size of the errors that the detector states: in 1,000 of these sessions 95.0 % of the true values are in
/// their 95 % intervals.
struct CameraCalibration {
  std::string date;                                           ///< UTC, YYYY-MM-DDTHH:MM:SSZ, of the fit
  bool mirrored = false;                                      ///< see imageAxes()
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();           ///< m, place of the tip that is seen at (tip_u, tip_v)
  Eigen::Vector2d reference_pixel = Eigen::Vector2d::Zero();  ///< px, of the tips' history; the image's centre
  Eigen::Vector2i image_size = Eigen::Vector2i::Zero();       ///< px, width and height; 0: not known, in an old file
  CalibrationVector<double> value = CalibrationVector<double>::Zero();  ///< 0 where not estimated
  std::array<bool, kCalibrationParameters> estimated{};
  Eigen::Matrix<double, kCalibrationParameters, kCalibrationParameters> covariance =
      Eigen::Matrix<double, kCalibrationParameters, kCalibrationParameters>::Zero();  ///< scaled by the residuals
  int freedom = 1;              ///< degrees of freedom of the pixels' residuals
  int focus_freedom = 1;        ///< and of the focus readings'
  double variance_factor = 1;   ///< residuals' variance over that of the observations' covariances
  double residual = 0;          ///< px rms of a coordinate, without outliers
  double focus_residual = 0;    ///< m rms
  int points = 0;               ///< tips used, without outliers
  int focus_points = 0;         ///< focus readings used
  int outliers = 0;             ///< left out
  std::vector<TipRecord> tips;  ///< of this holder, oldest first; the last one is the present tip

  Eigen::Matrix<double, 2, 3> axes() const { return imageAxes(value, mirrored); }        ///< px/m
  Eigen::Vector3d backlash() const { return value.segment<3>(kBacklashX).cwiseMax(0); }  ///< m, for Play
  /// Empty, or why the calibration is none of images of this width and height (px): binned or cropped images have
  /// other pixels. Any are taken while one of both sizes is not known (0).
  std::string refusalOf(const Eigen::Vector2i& size) const;
  /// Empty, or that nobody can tell whether the calibration is that of these images: their size is not known.
  std::string warning() const;
  /// 95 % interval by Student's t; a point where the parameter was not estimated.
  Interval interval(CalibrationParameter parameter) const;

  /// Pixel of a tip at `place` (m), and the covariance (px^2) that the parameters leave there.
  Eigen::Vector2d pixelOf(const Eigen::Vector3d& place) const;
  Eigen::Matrix2d pixelCovariance(const Eigen::Vector3d& place) const;
  /// Place (m) that is seen at `pixel`, for a place `y` (m) on the axis y, along which an image does not tell.
  Eigen::Vector3d placeFor(const Eigen::Vector2d& pixel, double y) const;

  /// Focus readings determined how the axes move the best focus.
  bool hasFocusAxes() const { return estimated[kFocusY]; }
  /// Best focus (m) of a tip at `place`; none without focus readings of this tip.
  std::optional<double> focusOf(const Eigen::Vector3d& place) const;
  /// Motion of the manipulator (m, per m of best focus) that leaves the tip at its pixel; none
  /// without focus axes.
  std::optional<Eigen::Vector3d> focusMotion() const;

  /// Motor positions (m), in order, that bring the tip from where `play` has it to `pixel`, with
  /// the backlash taken up (`Play::commandFor`). Axis y stays.
  std::vector<Eigen::Vector3d> commandFor(const Eigen::Vector2d& pixel, const Play& play) const;

  /// The tip as a record of the history: place (m) that brings it to the reference pixel.
  TipRecord tipRecord(const std::string& when) const;
};

/// One observation of a new tip, after a pipette change.
struct NewTip {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();                  ///< px
  Eigen::Matrix2d covariance = 0.04 * Eigen::Matrix2d::Identity();  ///< px^2
  std::optional<double> focus;                                      ///< m, its best focus
  double focus_deviation = 0.3e-6;                                  ///< m
};

struct RezeroResult {
  std::optional<CameraCalibration> calibration;  ///< none when it was refused
  std::string refusal;
  std::string warning;  ///< the new tip lies outside the holder's history
};

/// The calibration after a change of the pipette, by one observation instead of a new pattern of half a minute: the
/// axes and the camera are the same, and only the tip is elsewhere in its holder. Keeps the axes and moves the tip's
/// place only: the origin becomes the tip's place by `play`, seen at the observed pixel. Without a focus reading the
/// focus of the new tip is unknown; how the axes move it is kept. Refuses what is not finite and a play that is not
/// known in x and z. `date` as in CameraCalibration.
RezeroResult rezero(const CameraCalibration& calibration, const NewTip& tip, const Play& play, const std::string& date);

}  // namespace microinjection
