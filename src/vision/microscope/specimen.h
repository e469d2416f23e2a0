#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "base/config_reader.h"
#include "vision/microscope/microscope_scene.h"

namespace microinjection {

/// How things look that a session's simulator does not describe. Lengths are over the cell's radius
/// where nothing else is said.
struct SpecimenConfig {
  double zona_thickness = 0;      ///< of a cell without layers; 0: no zona
  double perivitelline_gap = 0;   ///< between zona and ooplasm
  double polar_body_radius = 0;   ///< 0: none
  double polar_body_angle = 2.4;  ///< rad, from the world's x towards its z
  int dust = 6;                   ///< specks
  int bubbles = 0;
  int seed = 1;  ///< of the places of dust and bubbles, and of the texture
  struct Needle {
    double tip_radius = 3e-6;     ///< m, outer
    double wall = 0.25;           ///< over the outer radius
    double taper = 0.07;          ///< growth of the radius over the length
    double shaft_radius = 10e-6;  ///< m, outer, where the taper ends
  } injection_pipette;
  struct Holder {
    double mouth_radius = 10e-6;  ///< m, of the hole
    double outer_radius = 30e-6;  ///< m
  } holding_pipette;

  static SpecimenConfig read(ConfigReader& reader);
};

/// What a session knows of the things under the microscope, in the world (m).
struct Specimen {
  /// What the needle has drawn in.
  struct InNeedle {
    double length = 0;    ///< m from the mouth
    bool broken = false;  ///< cytoplasm, instead of a tongue of the whole membrane
  };
  std::vector<Eigen::Vector3d> vertices;                   ///< of the cell's surface
  Eigen::Isometry3d cell = Eigen::Isometry3d::Identity();  ///< pose of the cell, with which its inside moves
  std::vector<std::array<int, 3>> triangles;
  double radius = 0;                        ///< m, of the undeformed cell
  double shell_thickness = 0;               ///< m, of the outer layer; 0: none
  std::optional<Eigen::Isometry3d> needle;  ///< origin at the tip, z along the pipette, away from the cell
  std::optional<Eigen::Isometry3d> holder;  ///< origin at the mouth, z away from the cell
  std::optional<InNeedle> in_needle;        ///< none: the bore is empty
  double in_holder = 0;  ///< m, that the cell reaches from the mouth into the holding pipette; 0: as its surface does
};

/// The picture's scene: the section of the cell's surface in the plane of constant y through the cell's origin, the
/// layers as its insets, the pipettes, and the tongues in these. A pipette along the line of sight is left out. The
/// cell has no outline when its surface has no closed section.
MicroscopeScene specimenScene(const SpecimenConfig& config, const Specimen& specimen);

}  // namespace microinjection
