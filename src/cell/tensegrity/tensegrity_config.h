#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// Filaments of one kind, bundled into each member of the structure: Table II of Ladjal, Hanus,
/// Ferreira, "Micro-to-nano biomechanical modeling for assisted biological cell injection". A
/// filament is a solid circular cylinder whose second moment follows from its bending stiffness, I
/// = BS / E. `count` filaments bonded side by side make a circular bundle of count times the
/// section, and so count^2 times the second moment. (If they slide on each other it is count times:
/// see looseBendingStiffness.)
struct FilamentConfig {
  double young_modulus = 0;      ///< E, Pa, > 0
  double bending_stiffness = 0;  ///< BS, N m^2, of one filament, > 0
  int count = 1;                 ///< filaments in a member, >= 1

  double filamentSection() const;                                             ///< S of one, m^2: sqrt(4 pi BS / E)
  double filamentRadius() const;                                              ///< of one, m
  double section() const { return count * filamentSection(); }                ///< of a member, m^2
  double radius() const;                                                      ///< of a member, m
  double axialStiffness() const { return young_modulus * section(); }         ///< E S of a member, N
  double bendingStiffness() const;                                            ///< E I of a member, bonded, N m^2
  double looseBendingStiffness() const { return count * bending_stiffness; }  ///< N m^2, sliding filaments
  /// Euler's buckling load of a member hinged at both ends, `length` m: pi^2 E I / length^2, N.
  double eulerLoad(double length) const;
};

/// A prestressed cable. Kelvin-Voigt, equation (9): stress = E strain + eta rate, eta = E times the
/// retardation time.
struct CableConfig {
  FilamentConfig filaments;
  double prestrain = 0.05;      ///< l / l0 - 1 in the structure at rest, >= 0
  double retardation_time = 0;  ///< s, >= 0; 0: elastic

  double tension() const { return filaments.axialStiffness() * prestrain; }  ///< N, at rest
};

struct StrutConfig {
  FilamentConfig filaments;
  double poisson_ratio = 0.3;       ///< in (-1, 0.5)
  std::string model = "corotated";  ///< linear (the paper's; wrong under rotation), st_venant_kirchhoff, corotated
  std::string element = "p1";       ///< p1 (the paper's; too stiff in bending when slender), p2
  int slices = 32;                  ///< of a strut along its length, even, >= 2
  double bow = 0.002;  ///< of its middle, over its length: no strut is straight, and a perfect one bifurcates
};

/// The viscoelastic biomembrane, which the paper mentions without data. All values are ours.
struct MembraneConfig {
  double young_modulus = 1e4;   ///< Pa, > 0
  double poisson_ratio = 0.3;   ///< in (-1, 0.5]
  double thickness = 1e-7;      ///< m, > 0
  double tension = 1e-4;        ///< N/m, at rest, >= 0; the pressure inside, 2 tension / radius, balances it
  double retardation_time = 0;  ///< s, >= 0, Kelvin-Voigt
  int divisions = 8;            ///< of each edge between neighbouring strut ends, >= 1
};

/// The paper's cytoskeleton (section III.A): six struts, 24 actin and 12 intermediate-filament
/// cables, in a membrane.
struct TensegrityConfig {
  double radius = 28e-6;             ///< orientation of the needle's axis, see TensegrityGeometry
  std::string orientation = "face";  ///< what the needle's axis meets on top, see TensegrityGeometry
  CableConfig actin, intermediate;
  StrutConfig microtubules;
  MembraneConfig membrane;
  std::vector<int> cut;  ///< numbers of the cables that are cut, see TensegrityGeometry

  TensegrityConfig();  ///< Table II, middle of its ranges, one filament in a member

  /// Whether cables or membrane are viscous.
  bool viscous() const;
  /// All errors, each "KEY = VALUE UNIT: must be ALLOWED"; empty when there are none.
  std::vector<std::string> errors() const;
  /// Throws ConfigError with all errors at once.
  void validate() const;
};

/// face, edge, vertex.
const std::vector<std::string>& tensegrityOrientations();
/// linear, st_venant_kirchhoff, corotated.
const std::vector<std::string>& strutModels();
/// p1, p2.
const std::vector<std::string>& strutElements();

}  // namespace microinjection
