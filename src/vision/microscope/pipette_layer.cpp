#include "vision/microscope/pipette_layer.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr float kStationsPerPixel = 2;
constexpr double kPathPerPhase = 1.0;  // rad of the path per phase of the optics, dic

using Value = EdgeResponse::Value;

/// A pipette in the image; lengths in px, `s` along the axis from the end face towards the shaft.
struct Tube {
  Eigen::Vector2f end, axis;
  double radius;         ///< at the end
  double growth;         ///< of the radius per px
  double largest;        ///< radius where the growth ends
  double inner;          ///< inner over outer radius
  double defocus;        ///< m, at the end
  double defocus_slope;  ///< m per px
  PipetteOptics optics;

  double radiusAt(double s) const { return std::min(largest, radius + growth * std::max(0.0, s)); }
};

/// What holds at one place of the axis.
struct Station {
  EdgeResponse::Depth depth, halo;
  float outer, inner, core;  ///< px, half widths
  float slant;               ///< cosine of the wall's angle to the axis
  float wall, lumen, gain, phase;
};

Station stationOf(const Tube& tube, const Optics& optics, double s) {
  Station station;
  const double defocus = tube.defocus + tube.defocus_slope * s;
  station.depth = optics.depth(defocus);
  station.halo = optics.haloDepth(defocus);
  const double radius = tube.radiusAt(s), inner = radius * tube.inner;
  const double glass = 1 - std::exp(-(radius - inner) * optics.pixelSize() / tube.optics.full_wall);
  station.outer = static_cast<float>(radius);
  station.inner = static_cast<float>(inner);
  station.core = static_cast<float>(inner * tube.optics.core_share);
  station.slant = static_cast<float>(radius < tube.largest ? 1 / std::hypot(1.0, tube.growth) : 1);
  station.wall = static_cast<float>(tube.optics.wall * glass);
  station.lumen = static_cast<float>(tube.optics.lumen * glass);
  station.gain = static_cast<float>(tube.optics.core * glass);
  station.phase = static_cast<float>(tube.optics.phase);
  return station;
}

/// Response of a band of half width `half` across the axis at distance `r` from it.
Value bandOf(const EdgeResponse::Depth& depth, float r, float half, float slant) {
  return depth.at((half - r) * slant) + depth.at((half + r) * slant) - Value(1, 0);
}

struct Change {
  float transmission, path;
};

/// The kernel of the edge response is a product of one along and one across the axis, so that the
/// response of a band with an end is the product of theirs.
Change changeAt(const Station& station, Optics::Look look, float r, const Value& end, float halo_end) {
  const Value outer = end * bandOf(station.depth, r, station.outer, station.slant);
  const Value inner = end * bandOf(station.depth, r, station.inner, station.slant);
  const Value core = end * bandOf(station.depth, r, station.core, station.slant);
  Change change{0, 0};
  change.transmission =
      -station.wall * (outer - inner).real() - station.lumen * (inner - core).real() + station.gain * core.real();
  if (look == Optics::Look::kPhase) {
    const float halo = halo_end * bandOf(station.halo, r, station.outer, station.slant).real();
    change.transmission -= 0.5F * station.phase * (outer.real() - halo);
  } else {
    change.transmission -= station.phase * (outer - inner).imag();
  }
  change.path = static_cast<float>(kPathPerPhase) * station.phase * (outer - 0.5F * inner).real();
  return change;
}

/// Columns [begin, end) of a row that may see the tube.
struct Span {
  int begin, end;
};

/// The region that sees the tube is a convex polygon around it.
std::vector<Eigen::Vector2f> hullOf(const Tube& tube, const std::vector<float>& widths, float back, double length) {
  const Eigen::Vector2f across(-tube.axis.y(), tube.axis.x());
  const auto step = static_cast<float>(length / static_cast<double>(widths.size() - 1));
  // The half width is concave where the radius stops growing and convex in the defocus: the widest
  // straight hull over the stations is taken.
  float first = widths.front(), slope = 0;
  for (std::size_t i = 1; i < widths.size(); ++i)
    slope = std::max(slope, (widths[i] - first) / (static_cast<float>(i) * step));
  const auto far = static_cast<float>(length);
  const Eigen::Vector2f near_end = tube.end - back * tube.axis, far_end = tube.end + far * tube.axis;
  const float wide = first + slope * far;
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
    back_ = static_cast<float>(end_.depth.reach());
    if (optics.look() == Optics::Look::kPhase) back_ = std::max(back_, static_cast<float>(end_.halo.reach()));
    const double length = farthest();
    const int count = static_cast<int>(length * kStationsPerPixel) + 2;
    for (int i = 0; i < count; ++i) {
      stations_.push_back(stationOf(tube, optics, i / kStationsPerPixel));
      widths_.push_back(reachOf(stations_.back()));
    }
    hull_ = hullOf(tube, widths_, back_, length);
  }

  void add() {
    for (int y = 0; y < image_.transmission.rows; ++y) {
      const Span span = spanOf(hull_, y, image_.transmission.cols);
      if (span.begin < span.end) addRow(y, span);
    }
  }

 private:
  /// px along the axis to the farthest corner of the image, and one more.
  double farthest() const {
    double length = 1;
    for (const int x : {0, image_.transmission.cols - 1}) {
      for (const int y : {0, image_.transmission.rows - 1}) {
        const Eigen::Vector2f corner(static_cast<float>(x), static_cast<float>(y));
        length = std::max<double>(length, (corner - tube_.end).dot(tube_.axis) + 2);
      }
    }
    return length;
  }

  float reachOf(const Station& station) const {
    double reach = station.depth.reach();
    if (optics_.look() == Optics::Look::kPhase) reach = std::max(reach, station.halo.reach());
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
      const auto place =
          std::min(static_cast<std::size_t>(std::max(0.0F, s * kStationsPerPixel + 0.5F)), stations_.size() - 1);
      if (s < -back_ || r > widths_[place]) continue;
      const float halo_end = optics_.look() == Optics::Look::kPhase ? end_.halo.at(s).real() : 1;
      const Change change = changeAt(stations_[place], optics_.look(), r, end_.depth.at(s), halo_end);
      transmission[x] *= std::max(0.0F, 1 + contrast * change.transmission);
      if (path) path[x] += contrast * change.path;
    }
  }

  const Tube& tube_;
  const Optics& optics_;
  OpticalImage& image_;
  Station end_;
  float back_;  ///< px before the end face that see it
  std::vector<Station> stations_;
  std::vector<float> widths_;  ///< px from the axis that see the station
  std::vector<Eigen::Vector2f> hull_;
};

}  // namespace

void addPipette(const HoldingPipette& pipette, double focus, const CameraView& view, const Optics& optics,
                OpticalImage& image) {
  Tube tube;
  tube.end = view.pixelOf(pipette.mouth).cast<float>();
  tube.axis = view.imageDirection(pipette.axis).cast<float>();
  tube.radius = pipette.outer_radius / view.pixel_size;
  tube.growth = pipette.taper;
  tube.largest = 3 * tube.radius;
  tube.inner = pipette.inner_radius / pipette.outer_radius;
  tube.defocus = pipette.y - focus;
  tube.defocus_slope = 0;
  tube.optics = pipette.optics;
  TubePicture(tube, optics, image).add();
}

void addPipette(const InjectionPipette& pipette, double focus, const CameraView& view, const Optics& optics,
                OpticalImage& image) {
  const Eigen::Vector2d in_image(pipette.axis.x(), pipette.axis.z());
  Tube tube;
  tube.end = view.pixelOf({pipette.tip.x(), pipette.tip.z()}).cast<float>();
  tube.axis = view.imageDirection(in_image).cast<float>();
  tube.radius = pipette.tip_radius / view.pixel_size;
  tube.growth = pipette.taper / in_image.norm();
  tube.largest = pipette.shaft_radius / view.pixel_size;
  tube.inner = 1 - pipette.wall;
  tube.defocus = pipette.tip.y() - focus;
  tube.defocus_slope = pipette.axis.y() / in_image.norm() * view.pixel_size;
  tube.optics = pipette.optics;
  TubePicture(tube, optics, image).add();
}

}  // namespace microinjection
