#include "vision/segmentation_training/training_scene.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr int kCorners = 180;
constexpr double kReferenceRadius = 50e-6;  // m, of the cell to whose size the widths of rims belong

Eigen::Vector2d direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Evenly in the logarithm.
double logWithin(RandomDraw& random, double low, double high) {
  return std::exp(random.within(std::log(low), std::log(high)));
}

/// A nearly round closed curve.
class Blob {
 public:
  Blob(RandomDraw& random, double ellipticity, double roughness) {
    for (int k = 2; k <= kWaves; ++k) {
      amplitude_[k] = (k == 2 ? random.within(0, ellipticity) : random.within(0, roughness) / (k - 1));
      phase_[k] = random.within(-M_PI, M_PI);
    }
  }
  double radiusAt(double angle) const {
    double radius = 1;
    for (int k = 2; k <= kWaves; ++k) radius += amplitude_[k] * std::cos(k * angle + phase_[k]);
    return radius;
  }
  CellOutline outline(const Eigen::Vector2d& centre, double radius) const {
    CellOutline outline;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * M_PI * i / kCorners;
      outline.emplace_back(centre + radius * radiusAt(angle) * direction(angle));
    }
    return outline;
  }

 private:
  static constexpr int kWaves = 6;
  double amplitude_[kWaves + 1] = {}, phase_[kWaves + 1] = {};
};

class TrainingSceneMaker {
 public:
  explicit TrainingSceneMaker(RandomDraw& random) : random_(random) {}

  TrainingScene make() {
    radius_ = random_.within(20e-6, 70e-6);
    drawCamera();
    drawLook();
    const double kind = random_.within(0, 1);
    if (kind < 0.58) addCell(placeOfMainCell(), true);
    if (kind > 0.42 && kind < 0.66) addSeveralCells();
    const bool has_cell = !made_.scene.cells.empty();
    if (random_.chance(has_cell ? 0.35 : 0.2)) addHolding();
    if (random_.chance(has_cell ? 0.35 : 0.6)) addInjection();
    addDebris();
    return made_;
  }

 private:
  const CameraView& view() const { return made_.microscope.camera; }
  /// m, of the image's height.
  double fieldHeight() const { return view().height * view().pixel_size; }

  void drawCamera() {
    CameraView& camera = made_.microscope.camera;
    const double aspect = random_.chance(0.6) ? random_.within(1.1, 1.5) : random_.within(0.8, 2.6);
    const double finer = random_.within(1, 1.4);
    camera.width = static_cast<int>(finer * std::min(256.0, 192 * aspect));
    camera.height = static_cast<int>(finer * std::min(192.0, 256 / aspect));
    camera.origin = {(camera.width - 1) / 2.0, (camera.height - 1) / 2.0};
    camera.angle = random_.within(-M_PI, M_PI);
    camera.mirrored = random_.chance(0.5);
    share_ = random_.chance(0.3) ? random_.within(0.11, 0.3) : random_.within(0.2, 0.98);
    camera.pixel_size = 2 * radius_ / (share_ * camera.height);
  }

  void drawLook() {
    MicroscopeConfig& microscope = made_.microscope;
    microscope.objective.numerical_aperture = random_.within(0.2, 0.9);
    microscope.objective.condenser_aperture = logWithin(random_, 0.03, 0.9);
    const double kind = random_.within(0, 1);
    microscope.contrast.mode = kind < 0.5   ? ContrastMode::kBrightField
                               : kind < 0.7 ? ContrastMode::kPhase
                                            : ContrastMode::kDic;
    microscope.contrast.strength = random_.within(0.5, 1.6);
    microscope.contrast.shear_angle = random_.within(-M_PI, M_PI);
    // At least half a pixel, so that a coarse image shows it, too.
    microscope.contrast.shear = std::clamp(random_.within(0.5, 1.5) * microscope.camera.pixel_size, 0.05e-6, 10e-6);
    microscope.contrast.halo = std::clamp(random_.within(0.03, 0.25) * radius_, 0.5e-6, 50e-6);
    made_.focus = random_.chance(0.15) ? random_.within(-40e-6, 40e-6) : random_.within(-15e-6, 15e-6);
  }

  Eigen::Vector2d placeIn(double beyond) {
    const double u = random_.within(-beyond, 1 + beyond), v = random_.within(-beyond, 1 + beyond);
    return view().worldOf({u * view().width, v * view().height});
  }

  Eigen::Vector2d placeOfMainCell() { return random_.chance(0.8) ? placeIn(-0.3) : placeIn(random_.within(-0.2, 0.1)); }

  void addSeveralCells() {
    const double size = radius_;
    for (int i = 1 + random_.upTo(4); i > 0; --i) {
      radius_ = size * random_.within(0.85, 1.15);
      for (int trial = 0; trial < 8; ++trial) {
        const Eigen::Vector2d place = placeIn(0.15);
        if (!isFree(place)) continue;
        addCell(place, false);
        break;
      }
    }
    radius_ = size;
  }

  bool isFree(const Eigen::Vector2d& place) const {
    return std::all_of(centres_.begin(), centres_.end(),
                       [&](const Eigen::Vector2d& centre) { return (place - centre).norm() > 2.1 * radius_; });
  }

  void addCell(const Eigen::Vector2d& centre, bool main) {
    if (main) {
      has_zona_ = random_.chance(0.72);
      look_ = drawCellLook();
    }
    CellScene cell = look_;
    cell.material = centre;
    cell.texture_seed = random_.bits() % 4096;
    cell.y = main ? 0 : random_.within(-5e-6, 5e-6);
    if (main) {
      main_centre_ = centre;
      main_radius_ = radius_;
    } else if (centres_.empty()) {
      has_zona_ = random_.chance(0.72);
      cell = look_ = drawCellLook();
      cell.material = centre;
    }
    has_zona_ ? addLayers(cell, centre) : addBareBorder(cell, centre);
    addNucleus(cell, centre);
    centres_.push_back(centre);
    const bool embryo = has_zona_ && random_.chance(0.12);
    const CellOutline ooplasm = cell.ooplasm;
    if (embryo) {
      cell.ooplasm.clear();
      cell.nucleus.reset();
    }
    made_.scene.cells.push_back(cell);
    if (embryo) addBlastomeres(cell, ooplasm, centre);
  }

  /// Cells of an embryo in place of the ooplasm; they overlap as seen from above.
  void addBlastomeres(const CellScene& embryo, const CellOutline& ooplasm, const Eigen::Vector2d& centre) {
    double room = radius_;
    for (const Eigen::Vector2d& corner : ooplasm) room = std::min(room, (corner - centre).norm());
    const int count = 2 + random_.upTo(6);
    const double size = room * (count == 2 ? 0.55 : count < 5 ? 0.48 : 0.38), begin = random_.within(-M_PI, M_PI);
    for (int i = 0; i < count; ++i) {
      const double angle = begin + 2 * M_PI * i / count + random_.within(-0.3, 0.3);
      const bool middle = count > 5 && i % 3 == 0;
      const double away = (room - size) * (middle ? random_.within(0, 0.5) : random_.within(0.85, 1));
      CellScene cell;
      cell.cytoplasm = embryo.cytoplasm;
      cell.material = centre + away * direction(angle);
      cell.texture_seed = random_.bits() % 4096;
      cell.y = embryo.y + random_.within(-4e-6, 4e-6);
      cell.ooplasm = Blob(random_, 0.06, 0.01).outline(cell.material, size * random_.within(0.85, 1.1));
      made_.scene.cells.push_back(cell);
    }
  }

  void addLayers(CellScene& cell, const Eigen::Vector2d& centre) {
    const Blob shell(random_, 0.03, 0.012);
    const double zona = radius_ * random_.within(0.05, random_.chance(0.2) ? 0.35 : 0.2);
    const double inner = radius_ - zona;
    const double kind = random_.within(0, 1);
    const double gap = inner * (kind < 0.45  ? random_.within(0, 0.05)
                                : kind < 0.8 ? random_.within(0.04, 0.2)
                                             : random_.within(0.15, 0.4));
    cell.zona_outer = shell.outline(centre, radius_);
    cell.zona_inner = shell.outline(centre, inner);
    const Eigen::Vector2d offset = random_.within(0, 0.8) * gap * direction(random_.within(-M_PI, M_PI));
    const double ooplasm = inner - gap;
    // Inside the shell, whose shape it shares where the gap is small.
    cell.ooplasm = gap > 0.06 * inner ? Blob(random_, 0.03, 0.012).outline(centre + offset, ooplasm)
                                      : shell.outline(centre + offset, ooplasm);
    if (random_.chance(0.5)) addPolarBody(cell, centre, inner, shell);
  }

  /// A polar body touches the zona, and the ooplasm gives way to it.
  void addPolarBody(CellScene& cell, const Eigen::Vector2d& centre, double inner, const Blob& shell) {
    const double size = inner * random_.within(0.08, 0.2), angle = random_.within(-M_PI, M_PI);
    const Eigen::Vector2d away = direction(angle), across(-away.y(), away.x());
    const double place = inner * shell.radiusAt(angle) - 1.05 * size;
    cell.polar_body = CellBody::polarBody(centre + place * away, size);
    vary(cell.polar_body->optics);
    cell.polar_body->optics.absorption += random_.within(-0.1, 0.25);
    double highest = 0;
    for (const Eigen::Vector2d& corner : cell.ooplasm) highest = std::max(highest, (corner - centre).dot(away));
    const double excess = std::max(0.0, highest - (place - 1.05 * size));
    for (Eigen::Vector2d& corner : cell.ooplasm) {
      const double side = (corner - centre).dot(across) / (1.3 * size);
      if ((corner - centre).dot(away) > 0) corner -= excess * std::exp(-side * side / 2) * away;
    }
  }

  void addBareBorder(CellScene& cell, const Eigen::Vector2d& centre) {
    cell.ooplasm = Blob(random_, 0.04, random_.chance(0.3) ? 0.03 : 0.008).outline(centre, radius_);
    if (random_.chance(0.5)) std::swap(cell.cytoplasm.rim_inside, cell.cytoplasm.rim_outside);
  }

  void addNucleus(CellScene& cell, const Eigen::Vector2d& centre) {
    if (!random_.chance(0.25)) return;
    const double size = radius_ * random_.within(0.1, 0.25);
    cell.nucleus =
        CellBody::nucleus(centre + random_.within(0, 0.35) * radius_ * direction(random_.within(-M_PI, M_PI)), size);
    vary(cell.nucleus->optics);
  }

  /// What all cells of an image share.
  CellScene drawCellLook() {
    CellScene cell;
    for (BodyOptics* body : {&cell.zona, &cell.perivitelline, &cell.cytoplasm}) vary(*body);
    cell.zona.absorption = random_.within(-0.12, 0.25);
    cell.perivitelline.absorption = -cell.zona.absorption * random_.within(0.3, 1.2);
    cell.cytoplasm.absorption = has_zona_ ? random_.within(-0.05, 0.5) : random_.within(-0.1, 0.3);
    if (random_.chance(0.3)) {  // full of lipid
      cell.cytoplasm.absorption = random_.within(0.4, 0.95);
      cell.cytoplasm.granules *= random_.within(0, 1);
    }
    if (random_.chance(0.2)) cell.cytoplasm.dome = random_.within(-0.2, 0.4);
    return cell;
  }

  void vary(BodyOptics& body) {
    const double width = radius_ / kReferenceRadius * logWithin(random_, 0.6, 3);
    for (double* value : {&body.rim_inside, &body.rim_outside, &body.line_width}) *value *= width;
    for (double* value : {&body.rim, &body.line, &body.dome}) *value *= random_.within(0, 1.6);
    body.phase *= random_.within(0.2, 2);
    body.absorption *= random_.within(0, 2);
    body.granules *= random_.within(0, 2);
  }

  PipetteOptics drawGlass(double thickness) {
    PipetteOptics optics;
    optics.wall = random_.chance(0.25) ? -random_.within(0.1, 1) : random_.within(0.1, 1);
    optics.core = random_.chance(0.5) ? random_.within(0, 0.3) : random_.within(0.2, 1.6);
    optics.core_share = random_.within(0.1, 0.8);
    optics.lumen = random_.chance(0.5) ? random_.within(-0.1, 0.15) : random_.within(0.1, 0.7);
    optics.phase = random_.within(0, 1);
    optics.full_wall = thickness * random_.within(0.1, 1);
    return optics;
  }

  void addHolding() {
    HoldingPipette pipette;
    const bool holds = !centres_.empty() && random_.chance(0.8);
    const double reference = holds && main_radius_ > 0 ? main_radius_ : radius_;
    pipette.axis = direction(random_.chance(0.6) ? sideAngle() : random_.within(-M_PI, M_PI));
    pipette.outer_radius = reference * random_.within(0.3, 1.05);
    pipette.inner_radius = pipette.outer_radius * random_.within(0.15, 0.85);
    pipette.inner_radius = std::min(pipette.inner_radius, 0.9 * reference);
    const double inner = pipette.inner_radius;
    const Eigen::Vector2d centre = holds ? (main_radius_ > 0 ? main_centre_ : centres_.front()) : placeIn(-0.2);
    const double away = std::sqrt(reference * reference - inner * inner);
    pipette.mouth = holds ? Eigen::Vector2d(centre + random_.within(0.97, 1.06) * away * pipette.axis) : centre;
    pipette.y = random_.within(-8e-6, 8e-6);
    pipette.taper = random_.chance(0.3) ? random_.within(0, 0.15) : 0;
    pipette.optics = drawGlass(pipette.outer_radius - inner);
    if (holds && main_radius_ > 0 && !has_zona_ && random_.chance(0.5)) aspirate(inner, pipette.axis);
    made_.scene.holding = pipette;
  }

  /// A tongue of a bare cell in the bore of the pipette that holds it.
  void aspirate(double bore, const Eigen::Vector2d& axis) {
    const Eigen::Vector2d across(-axis.y(), axis.x());
    const double half = 0.97 * bore, begin = std::sqrt(main_radius_ * main_radius_ - half * half);
    const double end = begin + random_.within(0, 6) * half;
    CellOutline outline;
    const double turn = std::asin(half / main_radius_);
    for (int i = 0; i < kCorners; ++i) {
      const double angle = turn + (2 * M_PI - 2 * turn) * i / (kCorners - 1);
      outline.emplace_back(main_centre_ + main_radius_ * (std::cos(angle) * axis + std::sin(angle) * across));
    }
    for (int i = 1; i < kCorners / 4; ++i) {
      const double angle = -M_PI / 2 + M_PI * i / (kCorners / 4);
      outline.emplace_back(main_centre_ + end * axis + half * (std::cos(angle) * axis + std::sin(angle) * across));
    }
    made_.scene.cells.front().ooplasm = outline;
  }

  /// Along a side of the image, as pipettes mostly are.
  double sideAngle() {
    const Eigen::Vector2d right = view().worldOf({1, 0}) - view().worldOf({0, 0});
    return std::atan2(right.y(), right.x()) + M_PI * random_.upTo(1) + random_.within(-0.35, 0.35);
  }

  void addInjection() {
    InjectionPipette pipette;
    const bool patch = random_.chance(0.4);
    const double scale = patch && random_.chance(0.5) ? fieldHeight() / 2 : std::min(radius_, fieldHeight() / 4);
    const Eigen::Vector2d axis = direction(random_.chance(0.5) ? sideAngle() : random_.within(-M_PI, M_PI));
    const double rise = random_.within(-0.6, 0.6);
    pipette.axis = {std::cos(rise) * axis.x(), std::sin(rise), std::cos(rise) * axis.y()};
    pipette.tip_radius = scale * logWithin(random_, 0.008, 0.14);
    pipette.taper = patch ? random_.within(0.08, 0.35) : random_.chance(0.3) ? 0 : random_.within(0.01, 0.13);
    pipette.shaft_radius = pipette.tip_radius + scale * random_.within(0.02, patch ? 1.5 : 0.5);
    pipette.wall = random_.within(0.12, 0.5);
    pipette.optics = drawGlass(pipette.wall * pipette.tip_radius);
    pipette.optics.wall = random_.chance(0.12) ? -random_.within(0.2, 0.8) : random_.within(0.3, 1);
    const Eigen::Vector2d tip = placeOfTip(axis);
    pipette.tip = {tip.x(), random_.within(-12e-6, 12e-6), tip.y()};
    if (patch) pipette.tip.y() = made_.focus + random_.within(-12e-6, 12e-6);
    made_.scene.injection = pipette;
  }

  Eigen::Vector2d placeOfTip(const Eigen::Vector2d& axis) {
    if (main_radius_ == 0 || random_.chance(0.3)) return placeIn(-0.08);
    const Eigen::Vector2d across(-axis.y(), axis.x());
    const double away = random_.chance(0.3) ? random_.within(-0.4, 0.9) : random_.within(0.95, 1.8);
    return main_centre_ + main_radius_ * (away * axis + random_.within(-0.4, 0.4) * across);
  }

  void addDebris() {
    const auto add = [&](Debris::Kind kind, double low, double high) {
      const Eigen::Vector2d place = placeIn(0.05);
      made_.scene.debris.push_back(
          {kind, {place.x(), random_.within(-20e-6, 20e-6), place.y()}, fieldHeight() * logWithin(random_, low, high)});
    };
    if (random_.chance(0.5))
      for (int i = random_.upTo(7); i > 0; --i) add(Debris::Kind::kDust, 0.003, 0.025);
    if (random_.chance(0.12))
      for (int i = 1 + random_.upTo(2); i > 0; --i) add(Debris::Kind::kBubble, 0.03, 0.35);
    if (!centres_.empty() && random_.chance(0.12)) addCumulus();
  }

  /// Small round cells that cling to the main one's border.
  void addCumulus() {
    const double size = radius_ * random_.within(0.04, 0.14);
    const double begin = random_.within(-M_PI, M_PI), width = random_.within(0.5, 2 * M_PI);
    for (int i = 10 + random_.upTo(60); i > 0; --i) {
      const double away = radius_ * random_.within(0.98, 1.02) + size * random_.within(0.8, 3);
      const Eigen::Vector2d place = centres_.front() + away * direction(begin + random_.within(0, width));
      made_.scene.debris.push_back(
          {Debris::Kind::kDust, {place.x(), random_.within(-5e-6, 5e-6), place.y()}, size * random_.within(0.5, 1.3)});
    }
  }

  RandomDraw& random_;
  TrainingScene made_;
  double radius_ = 0;  ///< m, of a cell
  double share_ = 0;   ///< diameter over the image's height
  std::vector<Eigen::Vector2d> centres_;
  Eigen::Vector2d main_centre_{0, 0};
  double main_radius_ = 0;  ///< m; 0: there is no main cell
  bool has_zona_ = false;
  CellScene look_;
};

}  // namespace

TrainingScene drawTrainingScene(RandomDraw& random) { return TrainingSceneMaker(random).make(); }

}  // namespace microinjection
