#include "vision/microscope/scene_draw.h"

#include <algorithm>
#include <cmath>

#include "base/config_errors.h"
#include "vision/microscope/tongue_outline.h"

namespace microinjection {
namespace {

constexpr int kCorners = 720;

Eigen::Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Semi-axes of an ellipse with the area of a circle.
struct Shape {
  double a, b;
};

Shape shapeOf(double radius, double ellipticity) {
  const double ratio = (1 + ellipticity) / (1 - ellipticity);
  return {radius * std::sqrt(ratio), radius / std::sqrt(ratio)};
}

class SceneMaker {
 public:
  SceneMaker(const SceneDrawConfig& config, const CameraView& view, std::uint64_t seed)
      : config_(config), view_(view), random_(seed) {}

  DrawnScene make() {
    centre_ = placeOfCell();
    tilt_ = random_.within(-config_.tilt, config_.tilt);
    has_cell_ = random_.chance(config_.cell);
    if (has_cell_) makeCell();
    if (random_.chance(config_.holding)) makeHolding();
    if (random_.chance(config_.injection)) makeInjection();
    addDebris();
    return drawn_;
  }

 private:
  Eigen::Vector2d placeOfCell() {
    if (config_.centred) return {0, 0};
    const Eigen::Vector2d offset(random_.within(-config_.place, config_.place),
                                 random_.within(-config_.place, config_.place));
    return view_.worldOf({(0.5 + offset.x()) * view_.width, (0.5 + offset.y()) * view_.height});
  }

  void makeCell() {
    CellScene cell;
    radius_ = random_.within(config_.diameter) / 2;
    const double zona = radius_ * random_.within(config_.zona), gap = radius_ * random_.within(config_.gap);
    ellipticity_ = config_.centred ? 0 : random_.within(0, config_.ellipticity);
    angle_ = random_.within(0, M_PI);
    const double inner = radius_ - zona, ooplasm = inner - gap;
    zona_ = zona;
    gap_ = gap;
    const Eigen::Vector2d ooplasm_centre = centre_ + random_.within(0, 0.5) * gap * unit(random_.within(-M_PI, M_PI));
    cell.zona_outer = outlineOf(centre_, radius_);
    cell.zona_inner = outlineOf(centre_, inner);
    cell.ooplasm = outlineOf(ooplasm_centre, ooplasm);
    cell.material = centre_;
    cell.texture_seed = random_.bits() % 4096;
    cell.y = random_.within(config_.cell_y);
    varyOptics(cell);
    CellTruth truth;
    truth.centre = view_.pixelOf(centre_);
    truth.diameter = 2 * radius_ / view_.pixel_size;
    truth.outer = axesOf(radius_);
    truth.zona_inner = axesOf(inner);
    truth.ooplasm = axesOf(ooplasm);
    truth.ooplasm_centre = view_.pixelOf(ooplasm_centre);
    truth.angle = imageAngle(unit(angle_));
    if (truth.angle < 0) truth.angle += M_PI;
    if (random_.chance(config_.nucleus)) {
      const double size = ooplasm * random_.within(0.18, 0.3);
      const double away = random_.within(0, ooplasm * 0.6);
      cell.nucleus = CellBody::nucleus(ooplasm_centre + away * unit(random_.within(-M_PI, M_PI)), size);
    }
    if (random_.chance(config_.polar_body)) addPolarBody(cell, truth, inner);
    drawn_.scene.cells.push_back(cell);
    drawn_.truth.cell = truth;
  }

  /// A polar body touches the zona, and the ooplasm gives way to it.
  void addPolarBody(CellScene& cell, CellTruth& truth, double inner) {
    const double size = inner * random_.within(0.09, 0.15);
    const Eigen::Vector2d direction = unit(random_.within(-M_PI, M_PI));
    const double away = inner * (1 - config_.ellipticity) - size;
    cell.polar_body = CellBody::polarBody(centre_ + away * direction, size);
    const Eigen::Vector2d across(direction.y(), -direction.x());
    double highest = 0;
    for (const Eigen::Vector2d& corner : cell.ooplasm) highest = std::max(highest, (corner - centre_).dot(direction));
    const double excess = std::max(0.0, highest - (away - 1.1 * size));
    for (Eigen::Vector2d& corner : cell.ooplasm) {
      const double side = (corner - centre_).dot(across) / (1.3 * size);
      if ((corner - centre_).dot(direction) > 0) corner -= excess * std::exp(-side * side / 2) * direction;
    }
    truth.polar_body_angle = imageAngle(direction);
  }

  void varyOptics(CellScene& cell) {
    for (BodyOptics* body : {&cell.zona, &cell.perivitelline, &cell.cytoplasm}) {
      const double strength = random_.within(0.6, 1.5);
      for (double* value : {&body->phase, &body->absorption, &body->rim, &body->line}) *value *= strength;
      body->granules *= random_.within(0.5, 1.6);
    }
    // Some species have oocytes full of lipid, which are nearly black.
    if (random_.chance(0.15)) {
      cell.cytoplasm.absorption = random_.within(0.4, 0.75);
      cell.cytoplasm.rim *= 0.3;
      cell.cytoplasm.granules = random_.within(0.1, 0.18);
    }
  }

  void makeHolding() {
    HoldingPipette pipette;
    pipette.axis = Eigen::Vector2d(std::sin(tilt_), -std::cos(tilt_));
    const double reference = has_cell_ ? radius_ : random_.within(config_.diameter) / 2;
    pipette.outer_radius = reference * random_.within(0.5, 0.9);
    pipette.inner_radius = pipette.outer_radius * random_.within(0.3, 0.65);
    const double inner = pipette.inner_radius;
    // The cell sits on the inner rim of the mouth.
    pipette.mouth = centre_ + std::sqrt(reference * reference - inner * inner) * pipette.axis;
    pipette.y = drawn_.scene.cells.empty() ? 0 : drawn_.scene.cells.front().y;
    pipette.optics.wall = random_.chance(0.25) ? -random_.within(0.3, 0.7) : random_.within(0.4, 0.8);
    pipette.optics.core = random_.within(0.05, 0.4);
    pipette.optics.lumen = random_.within(0, 0.25);
    const bool lost = has_cell_ && config_.lost > 0 && random_.chance(config_.lost);
    if (lost) pipette.mouth += (reachIn(pipette) + random_.within(config_.away)) * pipette.axis;
    if (has_cell_ && !lost) hold(pipette);
    drawn_.truth.held = has_cell_ && !lost;
    drawn_.scene.holding = pipette;
    drawn_.truth.holding = PipetteTruth{view_.pixelOf(pipette.mouth), view_.imageDirection(pipette.axis),
                                        pipette.outer_radius / view_.pixel_size, pipette.y};
  }

  void makeInjection() {
    InjectionPipette pipette;
    const double tilt = random_.within(-config_.tilt, config_.tilt), rise = random_.within(config_.inclination);
    const Eigen::Vector2d axis(std::sin(tilt), std::cos(tilt));
    pipette.axis = {std::cos(rise) * axis.x(), std::sin(rise), std::cos(rise) * axis.y()};
    pipette.tip_radius = random_.within(config_.tip_radius);
    pipette.taper = random_.within(0.03, 0.14);
    pipette.wall = random_.within(0.15, 0.4);
    pipette.shaft_radius = random_.within(20e-6, 60e-6);
    pipette.optics.wall = random_.within(0.5, 0.9);
    pipette.optics.core = random_.within(0.4, 1.2);
    pipette.optics.core_share = random_.within(0.25, 0.6);
    pipette.optics.lumen = random_.within(0.1, 0.5);
    const Eigen::Vector2d tip = has_cell_ && random_.chance(config_.dimple) ? indent(axis) : placeOfTip(axis);
    pipette.tip = {tip.x(), random_.within(config_.tip_y), tip.y()};
    if (config_.in_needle > 0 && random_.chance(config_.in_needle)) fill(pipette);
    drawn_.scene.injection = pipette;
    drawn_.truth.injection = PipetteTruth{view_.pixelOf(tip), view_.imageDirection(axis),
                                          pipette.tip_radius / view_.pixel_size, pipette.tip.y()};
  }

  /// Draws a column into the needle, of a whole membrane or of cytoplasm.
  void fill(InjectionPipette& pipette) {
    const double length = random_.within(config_.column), bore = (1 - pipette.wall) * pipette.tip_radius;
    pipette.column = random_.chance(0.5) ? BoreColumn::tongue(length, bore) : BoreColumn::cytoplasm(length, bore);
    pipette.column->texture_seed = random_.bits() % 4096;
    const double strength = random_.within(0.7, 1.4);
    BodyOptics& optics = pipette.column->optics;
    for (double* value : {&optics.phase, &optics.absorption, &optics.rim, &optics.line}) *value *= strength;
    optics.granules *= random_.within(0.3, 1.2);
    const double in_image = Eigen::Vector2d(pipette.axis.x(), pipette.axis.z()).norm();
    drawn_.truth.in_needle = length * in_image / view_.pixel_size;
  }

  /// m, that the cell reaches into the mouth without suction.
  double reachIn(const HoldingPipette& pipette) const {
    return (centre_ + distanceToBorder(pipette.axis) * pipette.axis - pipette.mouth).dot(pipette.axis);
  }

  /// Draws a tongue of the cell into the holding pipette, which presses its lip on the cell.
  void hold(const HoldingPipette& pipette) {
    const double own = reachIn(pipette);
    drawn_.truth.in_holder = own / view_.pixel_size;
    if (!(config_.in_holder > 0 && random_.chance(config_.in_holder))) return;
    const DrawingMouth mouth{pipette.mouth, pipette.axis, pipette.inner_radius,
                             own + random_.within(config_.tongue) * pipette.inner_radius};
    drawIn(mouth, zona_, gap_, drawn_.scene.cells.front());
    drawn_.truth.in_holder = mouth.length / view_.pixel_size;
  }

  Eigen::Vector2d placeOfTip(const Eigen::Vector2d& axis) {
    if (has_cell_ && config_.inside > 0 && random_.chance(config_.inside))
      return centre_ + radius_ * random_.within(0.2, 0.9) * axis;
    const double away = (has_cell_ ? radius_ : 0) + random_.within(3e-6, 40e-6);
    const Eigen::Vector2d across(axis.y(), -axis.x());
    return centre_ + away * axis + random_.within(-15e-6, 15e-6) * across;
  }

  /// Indents all borders along the needle's axis through the centre and returns the place of the
  /// tip. The displacement falls off as a bell curve across the axis, and towards the equator.
  Eigen::Vector2d indent(const Eigen::Vector2d& axis) {
    CellScene& cell = drawn_.scene.cells.front();
    CellTruth& truth = *drawn_.truth.cell;
    const double depth = std::min(random_.within(config_.dimple_depth), 0.3 * radius_);
    const double width = radius_ * random_.within(0.15, 0.3);
    const Eigen::Vector2d across(axis.y(), -axis.x());
    const Eigen::Vector2d top = centre_ + distanceToBorder(axis) * axis;
    const auto displaced = [&](const Eigen::Vector2d& point) -> Eigen::Vector2d {
      const double side = (point - centre_).dot(across) / width;
      const double height = std::clamp(2 * (point - centre_).dot(axis) / radius_, 0.0, 1.0);
      return point - depth * std::exp(-side * side / 2) * height * height * (3 - 2 * height) * axis;
    };
    for (CellOutline* outline : {&cell.zona_outer, &cell.zona_inner, &cell.ooplasm})
      for (Eigen::Vector2d& corner : *outline) corner = displaced(corner);
    if (cell.polar_body) {
      cell.polar_body->centre = displaced(cell.polar_body->centre);
      truth.polar_body_angle = imageAngle(cell.polar_body->centre - centre_);
    }
    if (cell.nucleus) cell.nucleus->centre = displaced(cell.nucleus->centre);
    truth.dimple_depth = depth / view_.pixel_size;
    truth.dimple = view_.pixelOf(top - depth * axis);
    return top - depth * axis;
  }

  /// m from the centre to the outer border along a unit vector.
  double distanceToBorder(const Eigen::Vector2d& direction) const {
    const Shape shape = shapeOf(radius_, ellipticity_);
    const double along = direction.dot(unit(angle_)), across = direction.dot(unit(angle_ + M_PI / 2));
    return 1 / std::hypot(along / shape.a, across / shape.b);
  }

  void addDebris() {
    const auto add = [&](Debris::Kind kind, double low, double high, double depth) {
      const Eigen::Vector2d pixel(random_.within(0, view_.width - 1), random_.within(0, view_.height - 1));
      const Eigen::Vector2d place = view_.worldOf(pixel);
      drawn_.scene.debris.push_back(
          {kind, {place.x(), random_.within(-depth, depth), place.y()}, random_.within(low, high)});
    };
    for (int i = random_.upTo(config_.dust); i > 0; --i) add(Debris::Kind::kDust, 0.5e-6, 3e-6, 40e-6);
    for (int i = random_.upTo(config_.bubbles); i > 0; --i) add(Debris::Kind::kBubble, 8e-6, 70e-6, 15e-6);
  }

  CellOutline outlineOf(const Eigen::Vector2d& centre, double radius) const {
    const Shape shape = shapeOf(radius, ellipticity_);
    return ellipseOutline(centre, shape.a, shape.b, angle_, kCorners);
  }
  Eigen::Vector2d axesOf(double radius) const {
    const Shape shape = shapeOf(radius, ellipticity_);
    return Eigen::Vector2d(shape.a, shape.b) / view_.pixel_size;
  }
  double imageAngle(const Eigen::Vector2d& world) const {
    const Eigen::Vector2d direction = view_.imageDirection(world);
    return std::atan2(direction.y(), direction.x());
  }

  const SceneDrawConfig& config_;
  const CameraView& view_;
  RandomDraw random_;
  DrawnScene drawn_;
  Eigen::Vector2d centre_{0, 0};
  bool has_cell_ = false;
  double radius_ = 0, ellipticity_ = 0, angle_ = 0;
  double zona_ = 0, gap_ = 0;  ///< m, thickness of the zona and of the gap within it
  double tilt_ = 0;            ///< rad, of the holding pipette
};

}  // namespace

void SceneDrawConfig::validate() const {
  ConfigErrors errors("scene draw");
  const auto probability = [&](const char* key, double value) { errors.require(Range::closed(0, 1), key, value); };
  probability("cell", cell);
  probability("polar_body", polar_body);
  probability("nucleus", nucleus);
  probability("holding", holding);
  probability("injection", injection);
  probability("dimple", dimple);
  probability("inside", inside);
  probability("lost", lost);
  probability("in_needle", in_needle);
  probability("in_holder", in_holder);
  errors.require(Range::closed(0, 1000), "dust", dust);
  errors.require(Range::closed(0, 1000), "bubbles", bubbles);
  const auto interval = [&](const char* key, const DrawInterval& value, const Range& range) {
    errors.require(range, key, value.low);
    errors.require(range, key, value.high);
    errors.require(value.low <= value.high, key, value.low, "", "not above the interval's end");
  };
  interval("diameter", diameter, Range::positive());
  interval("zona", zona, Range::closed(0.001, 0.4));
  interval("gap", gap, Range::closed(0, 0.4));
  interval("dimple_depth", dimple_depth, Range::nonNegative());
  interval("tip_radius", tip_radius, Range::positive());
  interval("column", column, Range::positive());
  interval("tongue", tongue, Range::positive());
  interval("away", away, Range::positive());
  interval("cell_y", cell_y, Range::finite());
  interval("tip_y", tip_y, Range::finite());
  interval("inclination", inclination, Range::closed(-1.4, 1.4));
  errors.require(Range::closed(0, 0.3), "ellipticity", ellipticity);
  errors.require(Range::closed(0, 1), "place", place);
  errors.require(Range::closed(0, M_PI), "tilt", tilt);
  errors.throwAny();
}

DrawnScene drawScene(const SceneDrawConfig& config, const CameraView& view, std::uint64_t seed) {
  config.validate();
  view.validate();
  return SceneMaker(config, view, seed).make();
}

}  // namespace microinjection
