#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/config_errors.h"
#include "base/config_reader.h"
#include "cell/model/aspirated_membrane.h"

namespace microinjection {

/// Failure of a cell's membranes under the needle, and the resistance of its shaft afterwards: a
/// scene's cell/puncture.
struct PunctureConfig {
  /// How the toughness grows with the needle's speed, see CrackSpeed.
  struct ToughnessRate {
    double speed = std::numeric_limits<double>::infinity();  ///< m/s, at which it is twice that of a slow needle
    double exponent = 1;
  };
  /// A membrane. It fails when one of its limits is reached; the others are infinite.
  struct Layer {
    std::string name = "zona";
    double force = std::numeric_limits<double>::infinity();   ///< N along the pipette
    double depth = std::numeric_limits<double>::infinity();   ///< m, indentation by the tip
    double strain = std::numeric_limits<double>::infinity();  ///< nominal, see strainAt()
    /// J/m^2, of crack: the solid is pierced by mechanics (PiercedBranch). Such layers are those of the cell, from the
    /// outermost on; infinite: not.
    double toughness = std::numeric_limits<double>::infinity();
    ToughnessRate toughness_rate;
    double barrier = 0;        ///< J, with toughness: beside the crack, to begin a hole
    double dimple_radius = 0;  ///< m, with strain: outer radius of the dent, from the pipette's axis
    double stiffness = 0;      ///< N/m along the pipette; 0 for the outermost layer, whose force is the cell's
    double gap = 0;            ///< m ahead of the tip when the previous layer fails; 0 for the outermost layer
    /// Pa, with toughness, of the outermost layer: traction at which its material breaks, see CohesiveWall; infinite:
    /// the balance of energy alone decides where it does.
    double strength = std::numeric_limits<double>::infinity();
    /// How suction in the needle's bore breaks it; none: it does not, only the limits above count.
    std::optional<AspirationConfig> aspiration;

    /// Meridional strain of a membrane that is straight from the rim of a tip of `tip_radius` c, m,
    /// at `indentation` w, m, to the outer radius of the dent: sqrt((a - c)^2 + w^2) / (a - c) - 1.
    /// This is the cone of a taut membrane without pressure behind it. For small w its
    /// w^2/(2(a-c)^2) is the strain in the derivation of Biomembrane with a uniform slope. It is
    /// nominal, not that of the solid underneath.
    double strainAt(double indentation, double tip_radius) const;
    /// Whether the layer fails at this `indentation`, m, with the force `push` along the
    /// pipette, N, when its limits are this share of those above.
    bool fails(double push, double indentation, double tip_radius, double strength = 1) const;
  };
  /// Forces on the part of the pipette in the cell.
  struct Shaft {
    double friction = 0;           ///< N, largest resistance of the hole's rim to sliding
    double adhesion = 0;           ///< N/m of shaft in the cytoplasm, in addition to friction
    double stiffness = 0.3;        ///< N/m along the pipette, before the shaft slides
    double damping = 0;            ///< N s/m per m of shaft in the cytoplasm (Pa s), against its motion
    double lateral_stiffness = 0;  ///< N/m, of the hole's rim, against motion across the pipette
    double coefficient = 0;        ///< Coulomb's, with toughness: of the wall that presses on the shaft
  };

  std::vector<Layer> layers;  ///< outermost first; none: the cell cannot be punctured
  Shaft shaft;
  double relaxation_time = 2e-3;     ///< s, in which the force after a failure falls to 1/e
  double cytoplasm_viscosity = 0.2;  ///< Pa s, of what flows into an aspirating needle; illustrative
  /// s, in which a hole that the needle has left regains all but 1/e of its layers' limits; infinite: it stays open.
  double resealing_time = std::numeric_limits<double>::infinity();

  /// Of the outermost layer, m, at which the traction that holds a crack closed is largest; 0: without a strength.
  double opening() const;
  int toughLayers() const;  ///< from the outermost on, pierced by mechanics

  /// One layer, which fails at `force`, N.
  static PunctureConfig atForce(double force);

  /// Reads the map under `puncture` of a scene.
  void read(ConfigReader reader);
  /// Adds the errors of this configuration. @param tip_radius m
  void check(double tip_radius, ConfigErrors& errors) const;
};

}  // namespace microinjection
