#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/material/material.h"
#include "cell/model/biomembrane.h"
#include "cell/model/puncture_config.h"
#include "cell/tensegrity/tensegrity_config.h"

namespace microinjection {

/// One cell, the pipette that holds it and the needle that enters it: the contents of a scene file
/// (config/cells/*.yaml), SI units. The cell's centre is the origin; the needle comes from above
/// along -z.
struct Scene {
  /// A ball or, around another layer, a spherical shell, bonded to its neighbours.
  struct Layer {
    std::string name = "cell";
    double outer_radius = 28e-6;  ///< m; the inner one is that of the next layer, or 0
    MaterialConfig material;
    double surface_tension = 0;  ///< N/m, of the outer surface or interface
  };
  struct Cell {
    std::vector<Layer> layers = {Layer()};  ///< outermost first; a homogeneous cell is one layer named "cell"
    /// Set for a tensegrity cell, which uses only the radius of its layer.
    std::optional<TensegrityConfig> tensegrity;
    PunctureConfig puncture;
    std::optional<BiomembraneConfig> biomembrane;  ///< for the membrane model only

    /// Material of the outermost layer: of the whole cell when it is homogeneous.
    MaterialConfig& material() { return layers.front().material; }
    const MaterialConfig& material() const { return layers.front().material; }
    double radius() const { return layers.front().outer_radius; }  ///< m
    double diameter() const { return 2 * radius(); }               ///< m

    std::vector<double> outerRadii() const;                              ///< m, of each layer
    std::vector<std::shared_ptr<const Material>> makeMaterials() const;  ///< of each layer
  };
  struct HoldingPipette {
    double contact_radius = 10e-6;  ///< m, of the circle on the surface that sticks to the mouth
  };
  struct Tip {
    std::string shape = "disc";  ///< one of tipShapes()
    double radius = 3e-6;        ///< m, of the disc or of the shaft
    double edge_radius = 0;      ///< m, of rounded_flat only, in (0, radius]

    bool rounded() const { return shape != "disc"; }
    double edgeRadius() const { return shape == "hemisphere" ? radius : edge_radius; }  ///< m, of any shape; disc: 0
  };
  struct Contact {
    std::string mode = "sticking";  ///< sticking, or sliding for rounded tips
    double friction = 0;            ///< Coulomb's coefficient, of sliding only, >= 0
    double adhesion_energy = 0;     ///< J/m^2, energy of separation, for rounded tips only, >= 0
    double adhesion_range = 0;      ///< m, gap of the largest traction, > 0 with adhesion; see TipContact
  };
  struct Needle {
    Tip tip;
    Contact contact;
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m, (x, y) of the needle's line
  };
  struct Refinement {
    double zone = 5;     ///< diameter of the puncture zone in needle diameters
    double density = 5;  ///< ratio of the element sizes outside and inside of the zone
  };
  struct Mesh {
    std::optional<double> size;  ///< m, of the elements outside of the puncture zone; see meshSize()
    Refinement refinement;
    double stretch = 1;  ///< of the elements along z, see CellMeshConfig
  };

  /// Requirements by which `model:=auto` chooses a model. A tensegrity scene has none.
  struct Requirements {
    double force_error = 0.02;  ///< relative, allowed
    double rate = 1000;         ///< Hz, of forces
  };

  Cell cell;
  HoldingPipette holding_pipette;
  Needle needle;
  Mesh mesh;
  Requirements requirements;

  double radius() const { return cell.radius(); }  ///< m

  /// mesh.size. Its default gives elements of one tip radius in the puncture zone, within 1/20 to
  /// 0.3 of the diameter (a finer tip in a large cell needs a higher density); m.
  double meshSize() const;

  /// Throws ConfigError with all errors at once.
  void validate() const;
  /// Throws ConfigError that names the purpose for a tensegrity cell, which has no mesh of its
  /// inside.
  void requireContinuum(const std::string& purpose) const;
};

/// disc (flat, with a sharp edge), hemisphere, rounded_flat.
const std::vector<std::string>& tipShapes();

/// Reads a scene file; ConfigError names file, key, value and what is allowed.
Scene loadScene(const std::string& path);

/// As loadScene; `origin` names the source in messages.
Scene parseScene(const YAML::Node& node, const std::string& origin);

}  // namespace microinjection
