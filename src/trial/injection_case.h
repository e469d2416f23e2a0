#pragma once

#include <Eigen/Core>
#include <optional>

#include "hardware/injector/pipette_flow.h"
#include "operation/control/injection_controller.h"
#include "trial/scaled_cell.h"

namespace microinjection {

/// What a random cell is, and what the operator believes of it.
struct InjectionCase {
  int seed = 0;
  ScaledCell::Properties cell;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m, of the needle's line from the cell's axis
  double gap = 0;                                    ///< m, of the tip above the cell at the start
  double believed_modulus = 0;                       ///< Pa
  PipetteConfig pipette;                             ///< of the needle
};

/// Diameter 20 to 150 um, even; modulus 2 to 45 kPa, even in its logarithm, known to a third; zona
/// failing at 0.03 to 0.13 E R^2 (0.09 to 0.31 diameters deep), in every second cell an oolemma
/// behind it; two Prony terms; offset up to 0.3 R; what a failure leaves falls in 1 to 10 ms, to a
/// friction of the shaft of up to 0.3 of the zona's strength.
InjectionCase randomInjectionCase(int seed);

/// A cell whose last membrane breaks by suction: diameter 50 to 150 um, modulus 1 to 5 kPa, even in its logarithm; a
/// bore of 2 to 3.5 um, at most 0.85 of the tip, whose filling is 2 to 50 times as viscous as water (a solution of
/// PVP); the membrane fails at a suction of 0.06 to 0.25 of the modulus, by a rate law in every second cell, and
/// cytoplasm of 0.1 to 1 Pa s follows. Without a membrane that breaks so in every tenth.
InjectionCase randomSuctionCase(int seed);

/// m, where the tip begins, above the cell.
Eigen::Vector3d startOf(const InjectionCase& of);

/// What an operator sets for a kind of cell: its diameter is seen, its modulus is assumed, the
/// layers are known.
InjectionControllerConfig injectionSettings(const InjectionCase& of);
/// The same for a cell that suction breaks, in a shallow dent.
InjectionControllerConfig suctionSettings(const InjectionCase& of);

/// What an estimator expects of the zona, which knows its strength with `deviation` (of its logarithm, 0: nothing
/// is known). The depth is that of all cells. Empty when nothing is known.
std::optional<ExpectedPuncture> expectedPuncture(const InjectionCase& of, double deviation);

}  // namespace microinjection
