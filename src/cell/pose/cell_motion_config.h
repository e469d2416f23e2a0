#pragma once

#include "base/config_errors.h"
#include "base/config_reader.h"

namespace microinjection {

/// A cell as a rigid sphere in its medium, with soft contacts.
struct CellMotionConfig {
  double radius = 40e-6;  ///< m, to the outside of the zona
  /// kg/m^3, of the cell less that of the medium. A value for a mouse oocyte was not found. Pig oocytes come to rest on
  /// 30 % sucrose (1127 kg/m^3) and sink through 15 % (1059), which shrinks them (Homa, Racowsky and McGaughey, J.
  /// Reprod. Fertil. 82 (1988) 81), so in a medium of 1005 they have less than 120. The speed at which a cell sinks
  /// measures it (doi 10.1177/2211068215583629 does so for pig oocytes).
  double density_difference = 50;
  double gravity = 9.81;        ///< m/s^2, towards the dish
  double viscosity = 0.7e-3;    ///< Pa s, of the medium: that of water at 37 degrees C
  double modulus = 8.26e3;      ///< Pa, Young's, for contacts: of the zona (mouse, MII: Murayama et al. 2006)
  double poisson_ratio = 0.49;  ///< of the cell
  /// m, the smallest gap of lubrication: the last film drains through the zona, a mesh of filaments, whose surface is
  /// no smoother than this (an assumption). Without it nothing would ever touch the dish (Brenner 1961).
  double roughness = 0.2e-6;
  double dish_height = 0;  ///< m, z of the dish's floor; z is up

  /// Coulomb's coefficients of the zona, >= 0.
  struct Friction {
    double lip = 0.3;
    double dish = 0.2;
    double needle = 0.1;
  };
  Friction friction;
  /// m/s, sliding speed at which friction reaches Coulomb's limit: below it a contact that sticks creeps.
  double creep_speed = 0.05e-6;

  double bore_length = 1e-3;    ///< m, of the holding pipette's narrow bore: its flow resistance is that of this tube
  double lost_distance = 1e-3;  ///< m, of the cell from the mouth, from which on the cell is lost

  double contactModulus() const;  ///< Pa, E / (1 - nu^2)
  double weight() const;          ///< N, less buoyancy
  double drag() const;            ///< N s/m, 6 pi mu R

  /// Reads the keys, which are the fields' names, but for the radius; SI.
  void read(ConfigReader reader);
  /// Throws ConfigError with all errors.
  void validate() const;
};

}  // namespace microinjection
