#include "vision/microscope/specimen.h"

#include <cmath>
#include <random>
#include <utility>

#include "vision/microscope/section_outline.h"
#include "vision/microscope/tongue_outline.h"

namespace microinjection {
namespace {

constexpr double kLeastDirection = 0.1;  // of an axis: its share in the image plane
constexpr double kField = 300e-6;        // m, side of the square with the dust

std::optional<Eigen::Vector2d> inImage(const Eigen::Vector3d& axis) {
  const Eigen::Vector2d seen(axis.x(), axis.z());
  if (seen.norm() < kLeastDirection) return std::nullopt;
  return seen.normalized();
}

/// The holding pipette's mouth with what it has drawn in; none: nothing.
std::optional<DrawingMouth> drawingMouth(const SpecimenConfig& config, const Specimen& specimen) {
  if (!specimen.holder || !(specimen.in_holder > 0)) return std::nullopt;
  const auto axis = inImage(specimen.holder->linear().col(2));
  if (!axis) return std::nullopt;
  const Eigen::Vector3d mouth = specimen.holder->translation();
  return DrawingMouth{{mouth.x(), mouth.z()}, *axis, config.holding_pipette.mouth_radius, specimen.in_holder};
}

CellScene cellScene(const SpecimenConfig& config, const Specimen& specimen, const CellOutline& outline) {
  CellScene cell;
  const Eigen::Vector3d place = specimen.cell.translation();
  cell.y = place.y();
  cell.material = {place.x(), place.z()};
  const double radius = specimen.radius;
  const double zona = specimen.shell_thickness > 0 ? specimen.shell_thickness : config.zona_thickness * radius;
  const double gap = config.perivitelline_gap * radius;
  cell.texture_seed = static_cast<std::uint64_t>(config.seed);
  if (zona > 0) {
    cell.zona_outer = outline;
    cell.zona_inner = insetOutline(outline, zona);
    cell.ooplasm = insetOutline(outline, zona + gap);
  } else {
    // A bare cell is a lens: the light that its border refracts is missing from a band inside of it.
    cell.ooplasm = outline;
    std::swap(cell.cytoplasm.rim_inside, cell.cytoplasm.rim_outside);
    cell.cytoplasm.line = 0;
  }
  if (config.polar_body_radius > 0) {
    const double away = radius - zona - config.polar_body_radius * radius;
    const Eigen::Vector3d body = specimen.cell * (away * Eigen::Vector3d(std::cos(config.polar_body_angle), 0,
                                                                         std::sin(config.polar_body_angle)));
    cell.polar_body = CellBody::polarBody({body.x(), body.z()}, config.polar_body_radius * radius);
  }
  if (const auto mouth = drawingMouth(config, specimen)) drawIn(*mouth, zona, gap, cell);
  return cell;
}

std::vector<Debris> debris(const SpecimenConfig& config) {
  std::mt19937_64 random(static_cast<std::uint64_t>(config.seed));
  std::uniform_real_distribution<double> place(-0.5 * kField, 0.5 * kField), depth(-30e-6, 30e-6), size(0.5e-6, 2e-6);
  std::vector<Debris> all;
  for (int i = 0; i < config.dust + config.bubbles; ++i) {
    Debris one;
    const bool bubble = i >= config.dust;
    one.kind = bubble ? Debris::Kind::kBubble : Debris::Kind::kDust;
    one.centre = {place(random), depth(random), place(random)};
    one.radius = (bubble ? 10 : 1) * size(random);
    all.push_back(one);
  }
  return all;
}

}  // namespace

SpecimenConfig SpecimenConfig::read(ConfigReader& reader) {
  SpecimenConfig config;
  const Range share = Range{0, 0.5, false, true};
  reader.number("zona_thickness", config.zona_thickness, share);
  reader.number("perivitelline_gap", config.perivitelline_gap, Range::closed(0, 0.3));
  reader.number("polar_body_radius", config.polar_body_radius, Range::closed(0, 0.4));
  reader.number("polar_body_angle", config.polar_body_angle, Range::closed(-2 * M_PI, 2 * M_PI));
  reader.integer("dust", config.dust, Range::closed(0, 200));
  reader.integer("bubbles", config.bubbles, Range::closed(0, 50));
  reader.integer("seed", config.seed, Range::closed(0, 1e9));
  ConfigReader needle = reader.section("injection_pipette");
  needle.number("tip_radius", config.injection_pipette.tip_radius, Range::positive());
  needle.number("wall", config.injection_pipette.wall, Range::open(0, 1));
  needle.number("taper", config.injection_pipette.taper, Range::closed(0, 1));
  needle.number("shaft_radius", config.injection_pipette.shaft_radius, Range::positive());
  if (config.injection_pipette.shaft_radius < config.injection_pipette.tip_radius)
    needle.error("shaft_radius", "must be at least tip_radius");
  ConfigReader holder = reader.section("holding_pipette");
  holder.number("mouth_radius", config.holding_pipette.mouth_radius, Range::positive());
  holder.number("outer_radius", config.holding_pipette.outer_radius, Range::positive());
  if (config.holding_pipette.outer_radius <= config.holding_pipette.mouth_radius)
    holder.error("outer_radius", "must be above mouth_radius");
  return config;
}

MicroscopeScene specimenScene(const SpecimenConfig& config, const Specimen& specimen) {
  MicroscopeScene scene;
  const CellOutline outline = sectionOutline(specimen.vertices, specimen.triangles, specimen.cell.translation().y());
  if (!outline.empty()) scene.cells.push_back(cellScene(config, specimen, outline));
  if (specimen.holder) {
    if (const auto axis = inImage(specimen.holder->linear().col(2))) {
      HoldingPipette pipette;
      const Eigen::Vector3d mouth = specimen.holder->translation();
      pipette.mouth = {mouth.x(), mouth.z()};
      pipette.axis = *axis;
      pipette.y = mouth.y();
      pipette.outer_radius = config.holding_pipette.outer_radius;
      pipette.inner_radius = config.holding_pipette.mouth_radius;
      scene.holding = pipette;
    }
  }
  if (specimen.needle && inImage(specimen.needle->linear().col(2))) {
    InjectionPipette pipette;
    pipette.tip = specimen.needle->translation();
    pipette.axis = specimen.needle->linear().col(2).normalized();
    pipette.tip_radius = config.injection_pipette.tip_radius;
    pipette.wall = config.injection_pipette.wall;
    pipette.taper = config.injection_pipette.taper;
    pipette.shaft_radius = config.injection_pipette.shaft_radius;
    if (specimen.in_needle && specimen.in_needle->length > 0) {
      const double bore = (1 - pipette.wall) * pipette.tip_radius, length = specimen.in_needle->length;
      pipette.column =
          specimen.in_needle->broken ? BoreColumn::cytoplasm(length, bore) : BoreColumn::tongue(length, bore);
    }
    scene.injection = pipette;
  }
  scene.debris = debris(config);
  return scene;
}

}  // namespace microinjection
