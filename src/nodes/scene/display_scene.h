#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "nodes/scene/cell_section.h"
#include "nodes/scene/cell_stress.h"
#include "operation/display/cell_members.h"
#include "operation/display/cell_surface.h"
#include "operation/display/colour_ranges.h"
#include "operation/display/display_config.h"
#include "operation/display/readout.h"

namespace microinjection {

/// State of the displayed scene, SI units; absent values are unknown or invalid.
struct DisplayedState {
  SurfaceQuantity colour = SurfaceQuantity::kDisplacement;  ///< wanted, of the surface
  CellIdentity cell;
  std::optional<CellSurface> surface;
  std::optional<DisplayedSolid> solid;
  std::vector<LayerBorder> borders;  ///< that the model has solved
  bool section = false;              ///< wanted
  CellMembers members;
  std::vector<Eigen::Vector3d> holes;                  ///< m, punctures of the outermost layer
  std::string cell_frame = "cell";                     ///< of surface, members and holes
  std::optional<Eigen::Isometry3d> holding_from_cell;  ///< pose of cell_frame in holding_pipette
  std::optional<Eigen::Isometry3d> tip;                ///< pose of needle_tip in world
  std::optional<Eigen::Isometry3d> tip_in_cell;        ///< the same in cell_frame
  std::optional<Eigen::Vector3d> proposed;             ///< m, place that a click has proposed for the tip, in world
  ColouredLines trail;                                 ///< of the tip, display units, in world
  std::optional<Eigen::Vector3d> predicted;            ///< N, of the cell on the tip, in world and cell_frame
  std::optional<Eigen::Vector3d> measured;             ///< N, as `predicted`
  Readout readout;
  bool alarm = false;  ///< the readout needs attention
};

/// Converts the state into rviz's markers below viz/world, viz/cell, viz/needle_tip and
/// viz/holding_pipette.
class DisplayScene {
 public:
  explicit DisplayScene(const DisplayConfig& config);

  /// The moving markers except the cell: forces, expected puncture and readout.
  void drawMoving(const DisplayedState& state, visualization_msgs::MarkerArray& markers) const;
  /// The cell's surface, edges, members and contact.
  void drawCell(const DisplayedState& state, visualization_msgs::MarkerArray& markers);
  /// The fixed markers: pipettes and legend.
  void drawFixed(const DisplayedState& state, visualization_msgs::MarkerArray& markers);
  /// Whether the colour scale has changed since drawFixed().
  bool fixedChanged() const { return fixed_changed_; }
  /// Why the surface does not have the wanted colour; empty if it has.
  const std::string& colourReason() const { return colour_reason_; }

 private:
  void drawForce(const std::string& name, const DisplayedState& state, const std::optional<Eigen::Vector3d>& force,
                 double beside, const Colour& colour, visualization_msgs::MarkerArray& markers) const;
  void drawProposed(const DisplayedState& state, visualization_msgs::MarkerArray& markers) const;
  void drawPuncture(const DisplayedState& state, visualization_msgs::MarkerArray& markers) const;
  void drawReadout(const DisplayedState& state, visualization_msgs::MarkerArray& markers) const;
  void drawSkin(const DisplayedState& state, const std::optional<DisplayedStress>& stress,
                const std::vector<double>& values, visualization_msgs::MarkerArray& markers);
  void drawMembers(const CellMembers& members, const std::string& frame, visualization_msgs::MarkerArray& markers);
  void chooseScale(SurfaceQuantity quantity, const std::vector<double>& values);
  void drawLegend(visualization_msgs::MarkerArray& markers) const;
  void fitHoldingPipette(const DisplayedState& state);

  const DisplayConfig config_;
  ColourRanges ranges_;
  ColourScale scale_;
  std::string colour_reason_;
  DrawnHoldingPipette holding_;  ///< as configured, with the mouth at the contact with the cell
  bool fixed_changed_ = false;
  double holding_height_ = 0;  ///< m, of the mouth along the z axis of holding_pipette
};

}  // namespace microinjection
