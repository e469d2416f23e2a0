#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>

#include "material/material.h"

namespace microinjection {

/// One cell, the pipette that holds it and the needle that enters it: the contents of a scene file
/// (config/cells/*.yaml), SI units. The cell's centre is the origin; the needle comes along -z.
struct Scene {
  struct Cell {
    double diameter = 56e-6;  ///< m
    MaterialConfig material;
    double puncture_force = std::numeric_limits<double>::infinity();  ///< N; infinity: is never punctured
  };
  struct HoldingPipette {
    double contact_radius = 10e-6;  ///< m, of the circle of the surface that sticks to the mouth
  };
  struct Tip {
    std::string shape = "disc";  ///< flat and sticking; the one shape there is
    double radius = 3e-6;        ///< m
  };
  struct Needle {
    Tip tip;
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m, (x, y) of the needle's line
  };
  struct Refinement {
    double zone = 5;     ///< diameter of the puncture zone in needle diameters
    double density = 5;  ///< how many times smaller elements are in the zone than elsewhere
  };
  struct Mesh {
    std::optional<double> size;  ///< m, of the elements outside of the puncture zone; see meshSize()
    Refinement refinement;
  };

  Cell cell;
  HoldingPipette holding_pipette;
  Needle needle;
  Mesh mesh;

  double radius() const { return cell.diameter / 2; }  ///< m

  /// mesh.size, or by default what puts elements of one tip radius into the puncture zone, 0.3 of the diameter at
  /// the most; m.
  double meshSize() const;

  /// Throws ConfigError with all errors at once.
  void validate() const;
};

/// Reads a scene file; ConfigError names file, key, value and what is allowed.
Scene loadScene(const std::string& path);

/// As loadScene; `origin` names the source in messages.
Scene parseScene(const YAML::Node& node, const std::string& origin);

}  // namespace microinjection
