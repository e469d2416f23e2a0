#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "vision/frame/ellipse.h"
#include "vision/frame/finding.h"
#include "vision/frame/polar_map.h"

namespace microinjection {

/// A centre is sure below this standard deviation, px.
constexpr double kSureCentre = 0.3;
/// px, standard deviation of a mean diameter beside that of its points, see diameterDeviation(). With it 98 to 99 % of
/// drawn and rendered diameters are within 1.96 deviations, without it 78 to 97 %: doc/design/detection.md.
constexpr double kModelDeviation = 0.05;

/// A closed border of a cell: its ellipse, and where it was seen. A border is searched in a polar map (PolarMap)
/// about a first centre, in which it is nearly a straight line:
///
///     ray  ^  . . . . # . . . . .     #  the closed path of the steepest slopes: a column for each ray
///          |  . . . . . # . . . .
///          |  . o . . . . . . . .     o  where the path crosses a pipette, a neighbour or debris it is off the
///          |  . . . . # . . . . .        ellipse, and its weight in the fit is 0
///          +---------------------> radius, columns
///
/// The steepest place of each ray by itself would jump between the lines of a zona and an ooplasm, and one gap would
/// break a contour that is followed. The path is the best one of all rays together that moves by a few columns from
/// ray to ray and closes, by dynamic programming; so a ray without an edge takes its place from its neighbours. An
/// ellipse is fitted to its points with Tukey's weights. A free contour would follow a dent or a pipette, and a
/// circle has too few parameters: oocytes are out of round by 0.5 % in the mean and 3.7 % at the most (section V.A of
/// the paper).
///
/// The search is coarse (findBorder), and what it finds is measured again at the frame's resolution (refineBorder),
/// in a narrow map, where the steepest place is known to a fraction of a pixel.
///
/// Shapes: `points` and `inlier` have one entry for each ray that sees the border, in order of direction.
struct CellBorder {
  Finding finding;
  bool centred = false;     ///< uncertain, but what displaces the border does so on all sides: its centre is sure
  bool which_line = false;  ///< uncertain, since it may be another one of several lines
  bool ringed = false;      ///< uncertain, since a ring is seen outside of it
  Ellipse ellipse;          ///< px
  Ellipse line;             ///< px, by its own line alone, which is followed from frame to frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of centre x, centre y, mean diameter, px^2
  double residual = 0;                                   ///< px rms, of the points that the ellipse describes
  double coverage = 0;      ///< share of the directions within the image in which the border is on the ellipse
  double outside = 0;       ///< share of the ellipse that is outside of the image
  double strength = 0;      ///< 0..1, of the gradient along it relative to what is around it
  double consistency = 0;   ///< share of the directions whose gradient is that of a border
  double contrast = 0;      ///< mean slope of the grey value along it, of full scale per px
  double significance = 0;  ///< mean gradient along it over the standard error of that
  Polarity polarity = Polarity::kRising;
  double shift = 0;                 ///< px, that the border is inside of the rising flank that shows it
  double rim = 0;                   ///< px, mean width of the dark rim along it; 0: none was seen
  double place = 0;                 ///< of the border in such a rim: 0 at its outer, 1 at its inner flank
  std::vector<cv::Point2d> points;  ///< px, in order of direction
  std::vector<bool> inlier;         ///< of each point
};

/// Which columns of a map a border may be in, by radius (px) for a direction (rad).
struct BorderBand {
  Ellipse inner, outer;  ///< an ellipse without axes does not limit
  double outwards = 0;   ///< strength that the last column has over the first: of two borders the outer is taken
  int most_change = 2;   ///< columns from ray to ray
};

/// Best closed border of a polarity in a map, with its ellipse. kNotFound when no ellipse fits, or fewer than three
/// of ten directions that are seen are on it.
/// @param scale      slope that counts as half of a full border, see slopeScale()
/// @param tolerance  px, distance up to which a point belongs to the ellipse
CellBorder findBorder(const Frame& frame, const PolarMap& map, Polarity polarity, const BorderBand& band, double scale,
                      double tolerance);

/// How a border appears, see refineBorder().
struct BorderRim {
  double widest = 0;  ///< px, of the dark rim that ends at the border's rising flank; 0: no rim
  double place = 0;   ///< of the border in the rim: 0 at its outer, 1 at its inner flank
};

/// The same border at the frame's resolution, to a fraction of a pixel: the steepest places of each
/// ray near `coarse`. Where a dark rim lies inside of a rising flank, the border is at the rim's
/// `place`; otherwise it is the flank.
/// @param window  px, to both sides of the flank
/// @param blur    px, standard deviation of the derivative along the ray
CellBorder refineBorder(const Frame& frame, const CellBorder& coarse, const BorderRim& rim, double window, double blur,
                        int rays);

/// How much a border is one: seen all round, clear and on its ellipse, in 0..1. A border from dark to
/// bright counts more: the rim of a cell is dark.
double borderScore(const CellBorder& border);

/// px, standard deviation of the border's mean diameter: that of its points, and what a border differs from an
/// ellipse of steepest places by. The points of a drawn cell scatter by nothing, and yet its diameter is that of its
/// pixels and of what smooths them.
double diameterDeviation(const CellBorder& border);

/// Share of an ellipse that is outside of the image.
double outsideShare(const Frame& frame, const Ellipse& ellipse);

/// An ellipse about the same centre with both axes changed by the factor.
Ellipse scaled(const Ellipse& ellipse, double factor);

}  // namespace microinjection
