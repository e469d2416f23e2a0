#include "nodes/scene/display_scene.h"

#include <algorithm>

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
constexpr Colour kProposed{1.00f, 0.31f, 1.00f, 1};  // as in the microscope's image
constexpr Colour kText{0.92f, 0.94f, 0.97f, 1};
constexpr Colour kAlarm{1.00f, 0.45f, 0.35f, 1};

constexpr float kMembrane = 0.25f;                          // opacity, of a cell with struts and cables inside
constexpr std::size_t kMostWithEdges = 5000;                // triangles; edges double the work of rviz
constexpr double kForceAbove = 0.2;                         // display units, from the tip to a force's arrow
constexpr double kHole = 0.03;                              // display units; not to scale
constexpr double kStrutWidth = 0.016, kCableWidth = 0.006;  // display units; not to scale
constexpr double kTrailWidth = 0.008;                       // display units; not to scale
constexpr double kCross = 0.1;                              // display units, from a proposed place to each end
constexpr double kGaugeHeight = 0.4;                        // display units, of the expected puncture's depth
const Eigen::Vector3d kGaugeTop(0.68, 0, -0.42);            // display units
const std::string kWorld = "viz/world";

}  // namespace

DisplayScene::DisplayScene(const DisplayConfig& config) : config_(config), holding_(config.holding_pipette) {
  chooseScale(SurfaceQuantity::kDisplacement, {});
}

void DisplayScene::chooseScale(SurfaceQuantity quantity, const std::vector<double>& values) {
  const double given = quantity == SurfaceQuantity::kDisplacement ? config_.colour_range : config_.stress_range;
  const double end = given > 0 ? given : ranges_.include(quantity, values);
  fixed_changed_ = fixed_changed_ || quantity != scale_.quantity || end != scale_.high;
  scale_ = {quantity, end};
}

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
  markers.markers.push_back(lineMarker({kWorld, "trail"}, state.trail, kTrailWidth));
  drawProposed(state, markers);
  drawPuncture(state, markers);
  drawReadout(state, markers);
}

void DisplayScene::drawProposed(const DisplayedState& state, visualization_msgs::MarkerArray& markers) const {
  LineList cross;
  for (int axis = 0; state.proposed && axis < 3; ++axis) {
    for (const double end : {-kCross, kCross})
      cross.push_back(config_.enlargement * *state.proposed + end * Eigen::Vector3d::Unit(axis));
  }
  markers.markers.push_back(lineMarker({kWorld, "proposed_place"}, cross, kTrailWidth, kProposed));
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
  SurfaceQuantity quantity = state.colour;
  std::optional<DisplayedStress> stress;
  std::string reason;
  const bool estimates_border = state.section && state.borders.empty();
  if (quantity != SurfaceQuantity::kDisplacement || estimates_border)
    stress = stressOf(surface, state.solid, state.predicted, reason);
  colour_reason_ = quantity != SurfaceQuantity::kDisplacement ? reason : "";
  const std::vector<double> values = valuesOf(surface, stress, quantity);
  ranges_.setCell(state.cell);
  chooseScale(quantity, valuesForScale(surface, quantity, values));
  drawSkin(state, stress, values, markers);
  const std::string frame = "viz/" + state.cell_frame;
  if (!state.members.kinds.empty()) drawMembers(state.members, frame, markers);
  std::vector<Eigen::Vector3d> holes;
  for (const Eigen::Vector3d& hole : state.holes) holes.push_back(toDisplay(hole, config_.enlargement));
  markers.markers.push_back(sphereMarker({frame, "holes"}, holes, kHole, kAlarm));
}

void DisplayScene::drawSkin(const DisplayedState& state, const std::optional<DisplayedStress>& stress,
                            const std::vector<double>& values, visualization_msgs::MarkerArray& markers) {
  const CellSurface& surface = *state.surface;
  const std::string frame = "viz/" + state.cell_frame;
  TriangleSoup skin = colouredSurface(surface, values, scale_, config_.enlargement);
  LineList mesh;
  if (config_.edges && surface.triangles.size() <= kMostWithEdges) mesh = edges(surface, 0.0015, config_.enlargement);
  std::vector<Eigen::Vector3d> contact = pointsAt(surface, surface.contact_vertices, config_.enlargement);
  // Members are inside of a membrane that is seen through, as it is.
  if (!state.members.kinds.empty()) {
    for (Colour& colour : skin.colours) colour.a = kMembrane;
  }
  if (state.section && state.members.kinds.empty()) {
    const Eigen::Isometry3d tip = state.tip_in_cell.value_or(Eigen::Isometry3d::Identity());
    CutPlane plane = CutPlane::along(tip.translation(), tip.linear().col(2));
    drawSection(frame, surface, bordersOf(surface, state.borders, state.solid, stress), plane, config_.enlargement,
                markers);
    plane.point = toDisplay(plane.point, config_.enlargement);
    skin = remains(skin, plane);
    mesh = remains(mesh, plane);
    const auto removed = [&](const Eigen::Vector3d& point) { return plane.height(point) > 0; };
    contact.erase(std::remove_if(contact.begin(), contact.end(), removed), contact.end());
  } else {
    removeSection(frame, markers);
  }
  markers.markers.push_back(triangleMarker({frame, "cell"}, skin, {1, 1, 1, 1}));
  markers.markers.push_back(sphereMarker({frame, "contact"}, contact, 0.005, kContact));
  if (config_.edges) markers.markers.push_back(lineMarker({frame, "edges"}, mesh, 0.001, kEdge));
}

void DisplayScene::drawMembers(const CellMembers& members, const std::string& frame,
                               visualization_msgs::MarkerArray& markers) {
  const double range = ranges_.includeTension(members.largestTension());
  markers.markers.push_back(lineMarker({frame, "struts"}, strutLines(members, config_.enlargement), kStrutWidth));
  const ColouredLines cables = cableLines(members, range > 0 ? range : 1, config_.enlargement);
  markers.markers.push_back(lineMarker({frame, "cables"}, cables, kCableWidth));
}

void DisplayScene::drawLegend(visualization_msgs::MarkerArray& markers) const {
  const Legend legend = colourLegend({0.68, 0, -0.25}, 0.5, scale_);
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
