#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/config_errors.h"
#include "base/config_reader.h"

namespace microinjection {

/// How a cell's membranes fail under the needle, and what holds its shaft afterwards: a scene's cell/puncture.
struct PunctureConfig {
  /// What the needle has to pierce. It fails once one of the three is reached; the others are infinite.
  struct Layer {
    std::string name = "zona";
    double force = std::numeric_limits<double>::infinity();   ///< N along the pipette
    double depth = std::numeric_limits<double>::infinity();   ///< m that the tip has pushed it in
    double strain = std::numeric_limits<double>::infinity();  ///< nominal, see strainAt()
    double dimple_radius = 0;  ///< m, with strain: where the dent ends, from the pipette's axis
    double stiffness = 0;      ///< N/m along the pipette; 0 of the outermost layer, whose force is the cell's
    double gap = 0;            ///< m before the tip when the layer before it fails; 0 of the outermost layer

    /// Meridional stretch, less 1, of a membrane that is straight from the rim of a tip of `tip_radius` c, m, `depth`
    /// w, m, deep to where the dent ends: sqrt((a - c)^2 + w^2) / (a - c) - 1. A cone, as of a taut membrane with no
    /// pressure behind it; for small w its w^2 / (2 (a - c)^2) is the strain in the derivation of Biomembrane with the
    /// slope taken even. Not of the solid underneath: nominal.
    double strainAt(double depth, double tip_radius) const;
    /// Whether it fails where the tip has pushed it `depth` in, m, with `push` along the pipette, N.
    bool fails(double push, double depth, double tip_radius) const;
  };
  /// Of the part of the pipette that is in the cell.
  struct Shaft {
    double friction = 0;           ///< N, that the hole's rim resists sliding with at the most
    double adhesion = 0;           ///< N/m of shaft in the cytoplasm, added to friction
    double stiffness = 0.3;        ///< N/m along the pipette, of what sticks to the shaft until it slides
    double damping = 0;            ///< N s/m per m of shaft in the cytoplasm (Pa s), against its motion
    double lateral_stiffness = 0;  ///< N/m, of the hole's rim, against motion across the pipette
  };

  std::vector<Layer> layers;  ///< outermost first; none: is never punctured
  Shaft shaft;
  double relaxation_time = 2e-3;  ///< s, in which the force that a failure leaves falls to 1/e

  /// One layer, which fails at `force`, N.
  static PunctureConfig atForce(double force);

  /// Of the map under `puncture` in a scene.
  void read(ConfigReader reader);
  /// @param tip_radius m
  void check(double tip_radius, ConfigErrors& errors) const;
};

}  // namespace microinjection
