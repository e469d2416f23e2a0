#include "vision/microscope/pipette_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "vision/microscope/tube_shape.h"

namespace microinjection {
namespace {

constexpr float kStationsPerPixel = 2;
constexpr float kWallPathPerPhase = 1.5F;  // rad of the path per phase of the optics, dic
constexpr double kFading = 0.25;           // of the wall's thickness
constexpr float kMiddle = 0.45F;           // darkness of the wall's middle over that of its outside
constexpr double kCoreWidth = 0.5;         // rms half width over the half width of the core
constexpr double kHoldingRim = 1.5e-6;     // m
constexpr float kSteepest = 0.97F;         // sine of the largest angle of a round lip,
constexpr float kSteepestCosine = 0.24F;   // and at most its cosine
constexpr float kRim = 0.5F;               // darkness of the end face's rim over that of the wall

using Value = EdgeResponse::Value;

/// A pipette in the image; lengths in px.
struct Tube : TubeShape {
  using TubeShape::TubeShape;
  double rim = 0;            ///< px, width of the end face's rim along the axis
  double defocus = 0;        ///< m, at the end
  double defocus_slope = 0;  ///< m per px
  PipetteOptics optics;
};

/// What holds at one place of the axis.
struct Station {
  EdgeResponse::Depth depth, halo;
  float outer, inner;  ///< px, half widths
  float slant;         ///< cosine of the wall's angle to the axis
  float fading;        ///< px into the wall over which its darkness falls to that of its middle
  float narrowness;    ///< 1/px^2, of the core: exp(-narrowness r^2)
  float wall, lumen, gain, phase;
};

Station stationOf(const Tube& tube, const Optics& optics, double s) {
  Station station;
  const double defocus = tube.defocus + tube.defocus_slope * s;
  station.depth = optics.depth(defocus);
  station.halo = optics.haloDepth(defocus);
  const double radius = tube.radiusAt(std::max(0.0, s)), inner = radius * tube.inner;
  const double glass = 1 - std::exp(-(radius - inner) * optics.pixelSize() / tube.optics.full_wall);
  station.outer = static_cast<float>(radius);
  station.inner = static_cast<float>(inner);
  station.slant = static_cast<float>(1 / std::hypot(1.0, tube.slopeAt(s)));
  station.fading = static_cast<float>(kFading * (radius - inner) + optics.blur(defocus));
  // The core is a bell curve, so that the blur widens and lowers it.
  const double width = kCoreWidth * inner * tube.optics.core_share, blurred = std::hypot(width, optics.blur(defocus));
  station.narrowness = static_cast<float>(1 / (2 * blurred * blurred));
  station.wall = static_cast<float>(tube.optics.wall * glass);
  station.lumen = static_cast<float>(tube.optics.lumen * glass);
  station.gain = static_cast<float>((tube.optics.core + tube.optics.lumen) * glass * width / blurred);
  station.phase = static_cast<float>(tube.optics.phase);
  return station;
}

/// Response of a band of half width `half` across the axis at distance `r` from it.
Value bandOf(const EdgeResponse::Depth& depth, float r, float half, float slant) {
  return depth.at((half - r) * slant) + depth.at((half + r) * slant) - Value(1, 0);
}

/// Darkness of a wall: the outer part turns away more light than the middle.
float darknessOf(const Station& station, float r) {
  const float into = (station.outer - r) / station.fading;
  return kMiddle + (1 - kMiddle) / (1 + into * into);
}

struct Change {
  float transmission, path;
};

/// The end face at a place: response along the axis, and that of the rim behind it.
struct End {
  Value value, rim;
  float halo;
};

/// The kernel of the edge response is a product of one along and one across the axis, so that the
/// response of a band with an end is the product of theirs. Without `end`: far behind it, where that is 1.
Change changeAt(const Station& station, ContrastMode mode, float r, const std::optional<End>& end) {
  const Value across = bandOf(station.depth, r, station.outer, station.slant);
  const Value lumen = bandOf(station.depth, r, station.inner, station.slant);
  const Value outer = end ? end->value * across : across;
  const Value inner = end ? end->value * lumen : lumen;
  const float core = (end ? end->value.real() : 1) * std::exp(-station.narrowness * r * r);
  Change change{0, 0};
  change.transmission = -station.wall * darknessOf(station, std::min(r, station.outer)) * (outer - inner).real() -
                        station.lumen * inner.real() + station.gain * core;
  if (end) change.transmission -= kRim * station.wall * ((end->value - end->rim) * across).real();
  if (mode == ContrastMode::kPhase) {
    const float halo = (end ? end->halo : 1) * bandOf(station.halo, r, station.outer, station.slant).real();
    change.transmission -= 0.5F * station.phase * (outer.real() - halo);
  } else {
    change.transmission -= station.phase * (2.0F * outer - inner).imag();
  }
  change.path = kWallPathPerPhase * station.phase * (outer - 0.5F * inner).real();
  return change;
}

/// Columns [begin, end) of a row that may see the tube.
struct Span {
  int begin, end;
};

/// The region that sees the tube from `begin` px of its axis on is a convex polygon around it.
/// `widths`: px from the axis that see each station.
std::vector<Eigen::Vector2f> hullOf(const Tube& tube, const std::vector<float>& widths, float begin, float back) {
  const Eigen::Vector2f across(-tube.axis.y(), tube.axis.x());
  // The half width is concave where the radius stops growing and convex in the defocus: the widest
  // straight hull over the stations is taken.
  const float first = widths.front();
  float slope = 0;
  for (std::size_t i = 1; i < widths.size(); ++i)
    slope = std::max(slope, (widths[i] - first) * kStationsPerPixel / static_cast<float>(i));
  const float length = static_cast<float>(widths.size()) / kStationsPerPixel;
  const Eigen::Vector2f near_end = tube.end + (begin - back) * tube.axis,
                        far_end = near_end + (back + length) * tube.axis;
  const float wide = first + slope * length;
  return {near_end + first * across, far_end + wide * across, far_end - wide * across, near_end - first * across};
}

Span spanOf(const std::vector<Eigen::Vector2f>& hull, int row, int width) {
  const auto y = static_cast<float>(row);
  float low = 1e9F, high = -1e9F;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    Eigen::Vector2f a = hull[i], b = hull[(i + 1) % hull.size()];
    if (a.y() > b.y()) std::swap(a, b);
    if (y < a.y() - 1 || y > b.y() + 1) continue;
    // A row's margin above and below, so that the hull's corners are inside.
    const float height = b.y() - a.y();
    const float first = height > 0 ? std::clamp((y - 1 - a.y()) / height, 0.0F, 1.0F) : 0;
    const float last = height > 0 ? std::clamp((y + 1 - a.y()) / height, 0.0F, 1.0F) : 1;
    for (const float t : {first, last}) {
      const float x = a.x() + t * (b.x() - a.x());
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  if (low > high) return {0, 0};
  const auto limit = static_cast<float>(width);
  return {static_cast<int>(std::clamp(std::floor(low), 0.0F, limit)),
          static_cast<int>(std::clamp(std::ceil(high) + 1, 0.0F, limit))};
}

/// Adds the tube row by row.
class TubePicture {
 public:
  TubePicture(const Tube& tube, const Optics& optics, OpticalImage& image)
      : tube_(tube), optics_(optics), image_(image) {
    end_ = stationOf(tube, optics, 0);
    lip_ = static_cast<float>(tube.lip);
    rim_ = static_cast<float>(tube.rim);
    back_ = static_cast<float>(end_.depth.reach());
    if (optics.contrastMode() == ContrastMode::kPhase) back_ = std::max(back_, static_cast<float>(end_.halo.reach()));
    far_ = lip_ + (back_ + rim_) / (lip_ > 0 ? kSteepestCosine : 1);
    placeStations();
  }

  void add() {
    if (stations_.empty()) return;
    for (int y = 0; y < image_.transmission.rows; ++y) {
      const Span span = spanOf(hull_, y, image_.transmission.cols);
      if (span.begin < span.end) addRow(y, span);
    }
  }

 private:
  /// Stations are where the image sees the axis: a tube may begin far outside.
  void placeStations() {
    float nearest = std::numeric_limits<float>::max(), farthest = -nearest;
    for (const int x : {0, image_.transmission.cols - 1}) {
      for (const int y : {0, image_.transmission.rows - 1}) {
        const Eigen::Vector2f corner(static_cast<float>(x), static_cast<float>(y));
        const float s = (corner - tube_.end).dot(tube_.axis);
        nearest = std::min(nearest, s);
        farthest = std::max(farthest, s);
      }
    }
    if (farthest < -back_) return;
    begin_ = std::floor(std::max(0.0F, nearest));
    const int count = static_cast<int>((std::max(0.0F, farthest) - begin_) * kStationsPerPixel) + 2;
    for (int i = 0; i < count; ++i) {
      stations_.push_back(stationOf(tube_, optics_, begin_ + static_cast<float>(i) / kStationsPerPixel));
      widths_.push_back(reachOf(stations_.back()));
    }
    hull_ = hullOf(tube_, widths_, begin_, back_);
  }

  float reachOf(const Station& station) const {
    double reach = station.depth.reach();
    if (optics_.contrastMode() == ContrastMode::kPhase) reach = std::max(reach, station.halo.reach());
    return station.outer + static_cast<float>(reach / station.slant);
  }

  void addRow(int y, const Span& span) {
    float* transmission = image_.transmission.ptr<float>(y);
    float* path = image_.path.empty() ? nullptr : image_.path.ptr<float>(y);
    const auto contrast = static_cast<float>(optics_.contrast());
    const float dy = static_cast<float>(y) - tube_.end.y();
    for (int x = span.begin; x < span.end; ++x) {
      const float dx = static_cast<float>(x) - tube_.end.x();
      const float s = dx * tube_.axis.x() + dy * tube_.axis.y();
      const float r = std::abs(dy * tube_.axis.x() - dx * tube_.axis.y());
      const auto place = std::min(static_cast<std::size_t>(std::max(0.0F, (s - begin_) * kStationsPerPixel + 0.5F)),
                                  stations_.size() - 1);
      if (s < -back_ || r > widths_[place]) continue;
      const std::optional<End> end = s < far_ ? std::optional<End>(endAt(s, r)) : std::nullopt;
      const Change change = changeAt(stations_[place], optics_.contrastMode(), r, end);
      transmission[x] *= std::max(0.0F, 1 + contrast * change.transmission);
      if (path) path[x] += contrast * change.path;
    }
  }

  /// A round lip is a circle on the middle of the wall: beside the middle the end lies behind it.
  End endAt(float s, float r) const {
    float behind = s;
    if (lip_ > 0 && r > end_.inner) {
      const float beside = std::min(std::abs(r - end_.outer + lip_) / lip_, kSteepest);
      const float cosine = std::sqrt(1 - beside * beside);
      behind = (s - lip_ * (1 - cosine)) * cosine;
    }
    const float halo = optics_.contrastMode() == ContrastMode::kPhase ? end_.halo.at(behind).real() : 1;
    return {end_.depth.at(behind), end_.depth.at(behind - rim_), halo};
  }

  const Tube& tube_;
  const Optics& optics_;
  OpticalImage& image_;
  Station end_;
  float lip_, rim_;  ///< px
  float back_;       ///< px before the end face that see it
  float far_;        ///< px along the axis from which on the end is not seen
  float begin_ = 0;  ///< px along the axis, of the first station
  std::vector<Station> stations_;
  std::vector<float> widths_;  ///< px from the axis that see the station
  std::vector<Eigen::Vector2f> hull_;
};

}  // namespace

void addPipette(const HoldingPipette& pipette, double focus, const CameraView& view, const Optics& optics,
                OpticalImage& image) {
  Tube tube(pipette, view);
  tube.rim = std::min(kHoldingRim, pipette.outer_radius - pipette.inner_radius) / view.pixel_size;
  tube.defocus = pipette.y - focus;
  tube.optics = pipette.optics;
  TubePicture(tube, optics, image).add();
}

void addPipette(const InjectionPipette& pipette, double focus, const CameraView& view, const Optics& optics,
                OpticalImage& image) {
  Tube tube(pipette, view);
  tube.rim = pipette.wall * pipette.tip_radius / view.pixel_size;
  tube.defocus = pipette.tip.y() - focus;
  tube.defocus_slope = pipette.axis.y() / Eigen::Vector2d(pipette.axis.x(), pipette.axis.z()).norm() * view.pixel_size;
  tube.optics = pipette.optics;
  TubePicture(tube, optics, image).add();
}

}  // namespace microinjection
