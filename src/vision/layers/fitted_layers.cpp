#include "vision/layers/fitted_layers.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vision/layers/layer_fit.h"

namespace microinjection {
namespace {

constexpr double kInFocusBlur = 1.8;   // px, of a cell in focus
constexpr double kLeastUsed = 0.5;     // share of the directions
constexpr double kSureRadius = 0.45;   // px, standard deviation of a radius that is sure
constexpr double kSeenRadius = 1;      // px, of one that is seen at all
constexpr double kOuterMisfit = 0.03;  // of the contrast, see LayerFit
constexpr double kOoplasmMisfit = 0.017;
constexpr double kLeastLead = 2;                        // of chi^2, of the inner border over the next best place
constexpr double kOnEllipse = 0.4, kNearEllipse = 0.8;  // px, of a border's points
constexpr double kMore = 0.04, kLeastOn = 0.5, kLeastNear = 0.4;  // shares of the points
constexpr double kSameRadius = 1;                                 // px, of two measurements of a radius
constexpr double kClearOfRim = 3;                                 // px, of the zona's line from the ooplasm's rim
constexpr double kSameSize = 0.01;                                // of the radius, from frame to frame
constexpr double kInnerModel = 0.25;     // px, as kOoplasmModel of cell_detector.cpp, of a zona's inner border
constexpr double kMostDeparture = 0.05;  // of the radius, that the fit may be from the first borders

double radiusOf(const Ellipse& ellipse) { return 0.5 * ellipse.meanDiameter(); }

void take(CellBorder& border, const LayerFit::Border& fit, const Finding& finding) {
  border.finding = finding;
  border.which_line = false;
  border.ellipse = fit.ellipse;
  border.covariance = fit.covariance;
  border.polarity = border.polarity == Polarity::kEither ? Polarity::kEither : Polarity::kRising;
}

double centreDeviation(const LayerFit::Border& fit) { return std::sqrt(fit.covariance(0, 0) + fit.covariance(1, 1)); }

bool describesOuter(const LayerFit& fit, const CellLayers& layers) {
  const double first = radiusOf(layers.zona_outer.ellipse);
  return fit.valid && fit.outer.line < 0 && fit.used >= kLeastUsed && fit.outer.deviation() < kSureRadius &&
         fit.outer.misfit < kOuterMisfit && std::abs(radiusOf(fit.outer.ellipse) - first) < kMostDeparture * first;
}

/// @return true: the fit describes the ooplasm's border roughly at least
bool takeOoplasm(const LayerFit& fit, ContrastMode mode, bool leads, CellLayers& layers) {
  const bool sure = fit.ooplasm.line < 0 && fit.ooplasm.deviation() < kSureRadius &&
                    fit.ooplasm.misfit < kOoplasmMisfit && centreDeviation(fit.ooplasm) < 2 * kSureRadius;
  const bool agree = std::abs(radiusOf(fit.ooplasm.ellipse) - radiusOf(layers.ooplasm.ellipse)) < kSameRadius;
  // In phase contrast the ooplasm is about as dark as its rim: one measurement alone may be a rim off.
  // Without a clear inner line of the zona the fit's rim and that line stand for each other.
  const bool own = layers.ooplasm.finding.isFound() && agree && !leads && mode != ContrastMode::kDic;
  if (sure && !own && (mode != ContrastMode::kPhase || (agree && layers.ooplasm.finding.isFound()))) {
    take(layers.ooplasm, fit.ooplasm, Finding::found());
    layers.ooplasm.shift = layers.ooplasm.rim = fit.ooplasm.width;
    return true;
  }
  if (layers.ooplasm.finding.isFound() && (!agree || mode == ContrastMode::kPhase))
    layers.ooplasm.finding = Finding::uncertain("the ooplasm's border is not separate from other lines beside it");
  return fit.ooplasm.line < 0 && fit.ooplasm.deviation() < 1.5 * kSureRadius && fit.ooplasm.misfit < 3 * kOoplasmMisfit;
}

/// @param leads      the inner border's place is the best by far
/// @param described  the fit describes the ooplasm
void takeInner(const LayerFit& fit, bool leads, bool described, CellLayers& layers) {
  // Where the ooplasm's border is not sure, only a line that is well outside of it is.
  const double apart = radiusOf(fit.inner.ellipse) - radiusOf(fit.ooplasm.ellipse) - fit.ooplasm.width -
                       cv::norm(fit.ooplasm.ellipse.centre - fit.inner.ellipse.centre);
  const bool clear = described || apart > kClearOfRim;
  const bool sure = leads && clear && fit.inner.line < 0 && fit.inner.deviation() < kSureRadius;
  take(layers.zona_inner, fit.inner,
       sure ? Finding::found() : Finding::uncertain("the zona's inner line is faint beside the ooplasm's rim"));
  layers.zona_inner.covariance(2, 2) += kInnerModel * kInnerModel;
  // A line that is not one, or not the only one, is no measurement: then there may be no gap at all.
  const bool seen = leads && fit.inner.line < 0 && fit.inner.deviation() < kSeenRadius;
  if (!seen) {
    const Ellipse& ooplasm = layers.ooplasm.ellipse;
    layers.zona_inner.ellipse = scaled(ooplasm, 1 + 0.5 * layers.ooplasm.rim / radiusOf(ooplasm));
    layers.zona_inner.covariance = layers.ooplasm.covariance;
    layers.zona_inner.finding =
        Finding::uncertain("the zona's inner line is not seen: the middle of the ooplasm's rim is given");
  }
  layers.zona_inner.rim = fit.inner.width;
  layers.zona_inner.coverage = fit.used;
}

bool isSharp(const LayerFit& fit) { return fit.valid && fit.blur < kInFocusBlur; }

double shareOn(const std::vector<cv::Point2d>& points, const Ellipse& ellipse) {
  const auto on = std::count_if(points.begin(), points.end(), [&](const cv::Point2d& point) {
    return std::abs(ellipse.distance(point)) < kOnEllipse;
  });
  return static_cast<double>(on) / std::max<double>(1, static_cast<double>(points.size()));
}

/// Where a needle bends the border, its points alone may give an ellipse that leans into the dimple. The
/// fit has left out the directions that are bent: of both ellipses, and that of the points near the
/// fit's, the one that most points are on is taken.
void settleOuter(const LayerFit& fit, CellBorder& border) {
  std::vector<cv::Point2d> near;
  for (const cv::Point2d& point : border.points) {
    if (std::abs(fit.outer.ellipse.distance(point)) < kNearEllipse) near.push_back(point);
  }
  const double before = shareOn(border.points, border.ellipse);
  const EllipseFit again = fitEllipse(near, fit.outer.ellipse, kOnEllipse);
  double most = before;
  if (again.valid && near.size() > kLeastNear * border.points.size() &&
      shareOn(border.points, again.ellipse) > most + kMore) {
    most = shareOn(border.points, again.ellipse);
    border.ellipse = again.ellipse;
    border.covariance = again.covariance;
    border.residual = again.residual;
  }
  if (most < kLeastOn) border.finding = Finding::uncertain("the border is bent over half of its length");
}

/// Takes what the fit describes in focus: true.
bool takeSharp(const LayerFit& fit, ContrastMode mode, bool leads, CellLayers& layers) {
  if (!isSharp(fit) || !describesOuter(fit, layers)) return false;
  const bool bright = mode != ContrastMode::kDic && mode != ContrastMode::kPhase;
  if (!bright || !layers.zona_outer.finding.isFound() || layers.zona_outer.rim == 0)
    take(layers.zona_outer, fit.outer, Finding::found());
  else
    settleOuter(fit, layers.zona_outer);
  // In phase contrast the ooplasm's border may be a rim off, the zona's line is not.
  takeInner(fit, leads, takeOoplasm(fit, mode, leads, layers) || mode == ContrastMode::kPhase, layers);
  return true;
}

/// Takes the certainty from what the fit does not describe. A border in focus that was found by itself
/// keeps it where the fit agrees.
void doubtAll(const LayerFit& fit, CellLayers& layers) {
  const auto agrees = [&](const CellBorder& border, const LayerFit::Border& measured) {
    return std::abs(radiusOf(border.ellipse) - radiusOf(measured.ellipse)) < kSameRadius &&
           cv::norm(border.ellipse.centre - measured.ellipse.centre) < kSameRadius;
  };
  const bool outer = isSharp(fit) && fit.outer.line < 0 && agrees(layers.zona_outer, fit.outer);
  const bool ooplasm = outer && fit.ooplasm.line < 0 && agrees(layers.ooplasm, fit.ooplasm);
  const Finding doubt =
      Finding::uncertain(isSharp(fit) ? "the grey values across the zona's border are unlike those of one"
                                      : "the cell is out of focus: its borders are displaced");
  for (CellBorder* border : {&layers.zona_outer, &layers.zona_inner, &layers.ooplasm}) {
    const bool agreed = border == &layers.ooplasm ? ooplasm : border == &layers.zona_outer && outer;
    if (!border->finding.isFound() || agreed) continue;
    border->finding = doubt;
    border->centred = border->polarity != Polarity::kEither;
  }
  // Defocus displaces a border on all sides alike: the centre of its circle stays.
  if (fit.valid && !isSharp(fit) && fit.used >= kLeastUsed && centreDeviation(fit.outer) < kSureCentre) {
    layers.zona_outer.ellipse.centre = fit.outer.ellipse.centre;
    layers.zona_outer.covariance.topLeftCorner<2, 2>() = fit.outer.covariance.topLeftCorner<2, 2>();
  }
}

/// The fit that starts from the ellipses of the frame before, moved (px).
LayerFit refit(const Frame& frame, ContrastMode mode, const CellLayers& previous, const cv::Point2d& moved) {
  LayerGuess guess{previous.zona_outer.ellipse, previous.ooplasm.ellipse, previous.ooplasm.rim,
                   radiusOf(previous.zona_outer.ellipse) - radiusOf(previous.zona_inner.ellipse)};
  guess.outer.centre += moved;
  guess.ooplasm.centre += moved;
  return fitLayers(frame, guess, mode);
}

/// Who knew which line it was in the frame before does not know whether this is that one.
void doubtChanged(CellBorder& border, const std::string& reason) {
  border.finding = Finding::uncertain(reason);
  border.centred = border.which_line = false;
}

/// A cell keeps its size from frame to frame: what does not is another border.
void requireSameSize(const CellBorder& previous, CellBorder& border) {
  const double before = radiusOf(previous.ellipse);
  if (!previous.finding.isFound() || !border.finding.isFound()) return;
  if (std::abs(radiusOf(border.ellipse) - before) > kSameSize * before)
    doubtChanged(border, "the cell has changed its size: this may be another border");
}

}  // namespace

void requireSameLine(const CellBorder& previous, CellBorder& border) {
  const double before = previous.line.meanDiameter();
  if (!border.finding.hasValues() || std::abs(border.line.meanDiameter() - before) < kSameSize * before) return;
  doubtChanged(border, "the border has changed its size: it may be another one");
}

bool fitLayersTo(const Frame& frame, ContrastMode mode, CellLayers& layers) {
  const LayerFit fit =
      fitLayers(frame, {layers.zona_outer.ellipse, layers.ooplasm.ellipse, layers.ooplasm.rim, 0}, mode);
  const bool leads = (1 - fit.rival) * fit.inner_gain > kLeastLead;
  if (takeSharp(fit, mode, leads, layers)) return true;
  doubtAll(fit, layers);
  return false;
}

void refitLayersTo(const Frame& frame, ContrastMode mode, const CellLayers& previous, CellLayers& layers) {
  CellBorder& outer = layers.zona_outer;
  if (!layers.zona_inner.finding.hasValues() ||
      previous.zona_inner.ellipse.meanDiameter() >= previous.zona_outer.ellipse.meanDiameter()) {
    if (!outer.finding.isFound()) return;
    outer.finding = previous.zona_outer.finding;
    outer.centred = previous.zona_outer.centred;
    return;
  }
  const bool leads = layers.zona_inner.finding.isFound();
  const cv::Point2d moved = outer.line.centre - previous.zona_outer.line.centre;
  if (mode == ContrastMode::kDic || mode == ContrastMode::kPhase) {
    // One line among others may not be the same in each frame: a cell that rests is fitted where it was.
    const LayerFit rests = refit(frame, mode, previous, {0, 0});
    if (takeSharp(rests, mode, leads, layers)) {
      outer.line = previous.zona_outer.line;
      outer.line.centre += outer.ellipse.centre - previous.zona_outer.ellipse.centre;
      requireSameSize(previous.zona_outer, outer);
      return;
    }
  }
  const LayerFit fit = refit(frame, mode, previous, moved);
  if (!takeSharp(fit, mode, leads, layers)) doubtAll(fit, layers);
  requireSameSize(previous.zona_outer, outer);
}

}  // namespace microinjection
