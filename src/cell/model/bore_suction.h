#pragma once

#include "cell/model/bore_tongue.h"
#include "cell/model/cell_model.h"

namespace microinjection {

/// What the pressure in a needle draws into its bore: the tongue of an intact cell, or the cytoplasm behind a membrane
/// that has broken.
///
///     behind the liquid      needle           mouth                        cell
///     suction s  --------- resistance R ------- s - R q ----- viscous ---- s_e(V)     q = dV/dt
///                                                3 eta / a^3 + 8 eta L / (pi a^4)
///
/// V is the volume of the cell in the bore and s_e(V) the suction that holds a tongue of this volume in equilibrium
/// (BoreTongue), so dV/dt = (s - s_e(V)) / (R + viscous); behind a broken membrane s_e = 0. The first viscous term is
/// that of an orifice (Sampson, Phil Trans 1891), the second that of a pipe (Poiseuille). Beyond the strongest suction
/// of an equilibrium s_e stays, and the tongue grows as fast as its viscosity lets it. Implicit steps, so that a tongue
/// that settles within a microsecond is its equilibrium.
///
/// The membrane's tension is nominal, as in micropipette aspiration: s_e a / (2 (1 - a/R)) of a half sphere over the
/// mouth of a cell of radius R (Laplace; Evans and Rawicz, Phys Rev Lett 1990). Beyond the last equilibrium it grows
/// with the tongue's length.
class BoreSuction {
 public:
  struct Config {
    double radius = 0;       ///< m, a
    double cell_radius = 0;  ///< m, R, above a
    double modulus = 0;      ///< Pa, of what is drawn in, that the tongue's suctions are over
    double viscosity = 0;    ///< Pa s, eta
  };
  /// What lies before the mouth.
  enum class Cover { kMedium, kMembrane, kCytoplasm };

  BoreSuction(const Config& config, BoreTongue tongue) : config_(config), tongue_(std::move(tongue)) {}

  /// Advances by dt (s, >= 0). Medium before the mouth takes away what was in the bore.
  void step(const CellModel::BoreLine& line, Cover cover, double dt);
  const CellModel::Bore& reading() const { return reading_; }

 private:
  double viscousResistance() const;
  void drawIn(const CellModel::BoreLine& line, Cover cover, double dt);
  double equilibriumSuction(double suction, double resistance, double dt) const;

  Config config_;
  BoreTongue tongue_;
  CellModel::Bore reading_;
};

}  // namespace microinjection
