#include "nodes/display/display_scene.h"

#include <algorithm>
#include <vector>

#include "nodes/display/display_markers.h"
#include "operation/display/force_arrow.h"
#include "operation/display/legend.h"
#include "operation/display/pipettes.h"

namespace microinjection {
namespace {

constexpr Colour kEdge{0.02f, 0.05f, 0.10f, 0.35f};
constexpr Colour kContact{1.00f, 0.36f, 0.20f, 1};
constexpr Colour kPredicted{1.00f, 0.70f, 0.20f, 1};
constexpr Colour kMeasured{0.95f, 0.40f, 0.80f, 1};
constexpr Colour kText{0.92f, 0.94f, 0.97f, 1};
constexpr Colour kAlarm{1.00f, 0.45f, 0.35f, 1};

constexpr double kSmallestRange = 1e-6;                     // m, of the colour scale, above the noise
constexpr float kMembrane = 0.25f;                          // opacity, of a cell with struts and cables inside
constexpr double kForceAbove = 0.2;                         // display units, from the tip to a force's arrow
constexpr double kHole = 0.03;                              // display units; not to scale
constexpr double kStrutWidth = 0.016, kCableWidth = 0.006;  // display units; not to scale
constexpr double kGaugeHeight = 0.4;                        // display units, of the expected puncture's depth
const Eigen::Vector3d kGaugeTop(0.68, 0, -0.42);            // display units
const std::string kWorld = "viz/world";

}  // namespace

DisplayScene::DisplayScene(const DisplayConfig& config)
    : config_(config),
      colour_range_(config.colour_range > 0 ? config.colour_range : kSmallestRange),
      holding_(config.holding_pipette) {}

void DisplayScene::drawForce(const std::string& name, const DisplayedState& state,
                             const std::optional<Eigen::Vector3d>& force, double beside, const Colour& colour,
                             visualization_msgs::MarkerArray& markers) const {
  std::optional<Arrow> arrow;
  if (state.tip && force) {
    // The arrow is beside the pipette and above the dent, which would hide it.
    const Eigen::Vector3d tail = *state.tip * Eigen::Vector3d(beside, 0, kForceAbove / config_.enlargement);
    arrow = forceArrow(tail, *force, config_.force_scale, config_.enlargement);
  }
  const MarkerName marker{kWorld, name};
  markers.markers.push_back(arrow ? arrowMarker(marker, *arrow, colour) : noMarker(marker));
}

void DisplayScene::drawMoving(const DisplayedState& state, visualization_msgs::MarkerArray& markers) const {
  const double beside = 1.6 * config_.injection_pipette.shaft_radius;
  drawForce("predicted_force", state, state.predicted, -beside, kPredicted, markers);
  drawForce("measured_force", state, state.measured, beside, kMeasured, markers);
  drawPuncture(state, markers);
  drawReadout(state, markers);
}

void DisplayScene::drawPuncture(const DisplayedState& state, visualization_msgs::MarkerArray& markers) const {
  constexpr int kLabels = 6;
  std::optional<DepthGauge> gauge;
  if (state.readout.puncture)
    gauge = depthGauge(kGaugeTop, kGaugeHeight, *state.readout.puncture, state.readout.indentation);
  const auto add = [&](const std::string& part, int id, const auto& marker) {
    const MarkerName name{kWorld, "puncture_" + part, id};
    markers.markers.push_back(gauge ? marker(name) : noMarker(name));
  };
  add("scale", 0, [&](const MarkerName& name) { return lineMarker(name, gauge->scale, 0.004, kText); });
  add("interval", 0, [&](const MarkerName& name) { return lineMarker(name, gauge->interval, 0.018, kAlarm); });
  add("expected", 0, [&](const MarkerName& name) { return sphereMarker(name, gauge->expected, 0.035, kAlarm); });
  add("depth", 0, [&](const MarkerName& name) { return sphereMarker(name, gauge->present, 0.03, kText); });
  for (int i = 0; i < kLabels; ++i) {
    add("labels", i, [&](const MarkerName& name) {
      return textMarker(name, gauge->labels[i].position, gauge->labels[i].text, 0.04, kText);
    });
  }
}

void DisplayScene::drawReadout(const DisplayedState& state, visualization_msgs::MarkerArray& markers) const {
  using About = ReadoutLine::About;
  constexpr int kMostLines = 14;
  const std::vector<ReadoutLine> shown = lines(state.readout);
  for (int i = 0; i < kMostLines; ++i) {
    const MarkerName name{kWorld, "readout", i};
    if (i >= static_cast<int>(shown.size())) {
      markers.markers.push_back(noMarker(name));
      continue;
    }
    const About about = shown[i].about;
    const Colour colour = about == About::kPredicted              ? kPredicted
                          : about == About::kMeasured             ? kMeasured
                          : about == About::kState && state.alarm ? kAlarm
                                                                  : kText;
    const Eigen::Vector3d position(-0.72, 0, 0.40 - 0.10 * i);
    markers.markers.push_back(textMarker(name, position, shown[i].text, 0.055, colour));
  }
}

void DisplayScene::drawCell(const DisplayedState& state, visualization_msgs::MarkerArray& markers) {
  if (!state.surface) return;
  const CellSurface& surface = *state.surface;
  if (config_.colour_range == 0) {
    const double range = niceCeiling(std::max(kSmallestRange, surface.largestDisplacement()));
    if (range > colour_range_) {
      colour_range_ = range;
      fixed_changed_ = true;
    }
  }
  const std::string frame = "viz/" + state.cell_frame;
  TriangleSoup skin = colouredSurface(surface, colour_range_, config_.enlargement);
  if (!state.members.kinds.empty()) {
    for (Colour& colour : skin.colours) colour.a = kMembrane;
    drawMembers(state.members, frame, markers);
  }
  markers.markers.push_back(triangleMarker({frame, "cell"}, skin, {1, 1, 1, 1}));
  markers.markers.push_back(sphereMarker(
      {frame, "contact"}, pointsAt(surface, surface.contact_vertices, config_.enlargement), 0.008, kContact));
  std::vector<Eigen::Vector3d> holes;
  for (const Eigen::Vector3d& hole : state.holes) holes.push_back(toDisplay(hole, config_.enlargement));
  markers.markers.push_back(sphereMarker({frame, "holes"}, holes, kHole, kAlarm));
  if (config_.edges)
    markers.markers.push_back(lineMarker({frame, "edges"}, edges(surface, 0.0015, config_.enlargement), 0.001, kEdge));
}

void DisplayScene::drawMembers(const CellMembers& members, const std::string& frame,
                               visualization_msgs::MarkerArray& markers) {
  tension_range_ = std::max(tension_range_, members.largestTension());
  markers.markers.push_back(lineMarker({frame, "struts"}, strutLines(members, config_.enlargement), kStrutWidth));
  const ColouredLines cables = cableLines(members, tension_range_ > 0 ? tension_range_ : 1, config_.enlargement);
  markers.markers.push_back(lineMarker({frame, "cables"}, cables, kCableWidth));
}

void DisplayScene::drawLegend(visualization_msgs::MarkerArray& markers) const {
  const Legend legend = displacementLegend({0.68, 0, -0.25}, 0.5, colour_range_);
  markers.markers.push_back(triangleMarker({kWorld, "legend"}, legend.bar, {1, 1, 1, 1}));
  int id = 0;
  for (const Legend::Label& label : legend.labels) {
    markers.markers.push_back(textMarker({kWorld, "legend_labels", id++}, label.position, label.text, 0.045, kText));
  }
}

void DisplayScene::fitHoldingPipette(const DisplayedState& state) {
  if (!state.surface || !state.holding_from_cell || state.surface->held_vertices.empty()) return;
  std::vector<Eigen::Vector3d> held;
  for (const int vertex : state.surface->held_vertices) {
    held.push_back(*state.holding_from_cell * state.surface->vertices[vertex]);
  }
  const Mouth mouth = fitMouth(held);
  if (!(mouth.radius > 0 && mouth.radius < holding_.outer_radius)) return;
  holding_.mouth_radius = mouth.radius;
  holding_height_ = mouth.height;
}

void DisplayScene::drawFixed(const DisplayedState& state, visualization_msgs::MarkerArray& markers) {
  fitHoldingPipette(state);
  visualization_msgs::Marker holding =
      triangleMarker({"viz/holding_pipette", "holding_pipette"}, glass(holding_, config_.enlargement), {1, 1, 1, 1});
  holding.pose.position.z = config_.enlargement * holding_height_;
  markers.markers.push_back(holding);
  const MarkerName injection{"viz/needle_tip", "injection_pipette"};
  markers.markers.push_back(
      state.tip ? triangleMarker(injection, glass(config_.injection_pipette, config_.enlargement), {1, 1, 1, 1})
                : noMarker(injection));
  drawLegend(markers);
  fixed_changed_ = false;
}

}  // namespace microinjection
