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
/// (config/cells/*.yaml, keys in doc/reference/scene_file.md), SI units. The cell's centre is the origin; the needle
/// comes from above along -z.
///
///                 z
///               | : |       needle: tip radius, offset (x, y) of its line
///               | : |
///                `-'
///             .--:--.
///           .'  .-.  `.
///          /   /   \   \    layers, outermost first, each bonded to its neighbours
///         (   (  +..)...)........ x
///          \   \   /   /
///           `.  `-'  .'
///             |--:--|       holding pipette: its mouth sticks to a circle of `contact_radius`, or holds the cell by
///             |  :  |       suction
///
/// Every model reads this one struct, so that a converged, a live and a surrogate force of one file can be compared.
/// The layers are spheres rather than measured outlines for two reasons: a mouse oocyte is out of round by 0.5 % in the
/// mean and 3.7 % at most (section V.A of the paper, doc/reference/paper.md), and a body of revolution can be solved in
/// its section, in seconds. The defaults are the paper's (Table I: 56 um, 17.9 kPa, 0.49; section IV.A: a zone of five
/// needle diameters, five times finer). Tip and holding radius are assumed, because the paper does not give them.
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
  struct Contact {
    std::string mode = "sticking";  ///< sticking, or sliding for rounded tips
    double friction = 0;            ///< Coulomb's coefficient, of sliding only, >= 0
    double adhesion_energy = 0;     ///< J/m^2, energy of separation, for rounded tips only, >= 0
    double adhesion_range = 0;      ///< m, gap of the largest traction, > 0 with adhesion; see RigidContact
  };
  /// A hollow pipette's end and the pressure in it: see PipetteMouth and SuctionLoad.
  struct Mouth {
    double inner_radius = 0;  ///< m, of the bore
    double outer_radius = 0;  ///< m
    double edge_radius = 0;   ///< m, of the rounded lip, at most half of the wall
    double pressure = 0;      ///< Pa, gauge, in the bore; suction is below 0
    Contact contact;          ///< of the lip with the cell
  };
  /// Without a mouth the surface in a circle is fixed, as in the paper (III.B). With one, suction holds the cell and
  /// deforms it there.
  struct HoldingPipette {
    double contact_radius = 10e-6;  ///< m, of the circle on the surface that is fixed; with a mouth, that it touches
    std::optional<Mouth> mouth;
  };
  /// A disc is the paper's nodal contact: the vertices under it stick to it. Its sharp edge folds the surface of a
  /// nonlinear cell, so a converged force ends early: 8 um deep with elements of 0.4 um at the edge, compared with 45
  /// um under a hemisphere (doc/reference/benchmarks.md, Where a converged force ends).
  struct Tip {
    std::string shape = "disc";  ///< one of tipShapes()
    double radius = 3e-6;        ///< m, of the disc or of the shaft
    double edge_radius = 0;      ///< m, of rounded_flat only, in (0, radius]
    double taper = 0;            ///< rad, of the shaft's wall to its axis; felt in a cell that is pierced by mechanics

    bool rounded() const { return shape != "disc"; }
    double edgeRadius() const { return shape == "hemisphere" ? radius : edge_radius; }  ///< m, of any shape; disc: 0
  };
  struct Needle {
    Tip tip;
    /// m, inner, at the mouth; none: nothing can be drawn in. It does not change the force on the tip.
    std::optional<double> bore_radius;
    Contact contact;
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m, (x, y) of the needle's line
  };
  /// Of P1Cell's mesh. The meshes of all other continua follow the radii of tip, cell and holding pipette
  /// (scene_mesh.h).
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

  /// Checks what no cell of any size can have, such as a tip wider than the cell: a scene without dimension (radius 1)
  /// is valid. parseScene also refuses sizes that no real cell has. Throws ConfigError with all errors at once.
  void validate() const;
  /// Throws ConfigError that names the purpose for a tensegrity cell, which has no mesh of its
  /// inside.
  void requireContinuum(const std::string& purpose) const;
  /// Throws ConfigError that names the purpose for a cell that suction holds.
  void requireGlued(const std::string& purpose) const;
  /// The scene with its cell glued to a ring where it would first touch the mouth that now holds it by suction; itself
  /// without a mouth. Of a cell 80 um across in a bore of 24 um, the needle's force on the axis then is up to 6 % from
  /// that of the held cell (doc/reference/benchmarks.md, Suction); AxisForceRatio knows the ratio of others.
  Scene glued() const;
  /// Largest relative difference of the needle's force between the two, of one homogeneous cell in 20 cases:
  /// ./dev bench suction.
  static constexpr double kGluedError = 0.06;
};

/// disc (flat, with a sharp edge), hemisphere, rounded_flat.
const std::vector<std::string>& tipShapes();

/// Reads a scene file and validates it; ConfigError names file, line, key, value and what is allowed.
Scene loadScene(const std::string& path);

/// As loadScene, for a scene that is no file of its own; `origin` names the source in messages, which have no line.
Scene parseScene(const YAML::Node& node, const std::string& origin);

}  // namespace microinjection
