#pragma once

#include <memory>
#include <optional>

#include "benchmark/common/teleoperation_loop.h"
#include "cell/model/puncturable_cell.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// What a pierced cell has in place of the toughness and friction of config/cells/mouse_oocyte_tough.yaml.
struct PiercedCase {
  const char* name;
  double toughness;    ///< J/m^2
  double coefficient;  ///< of friction, of the wall on the shaft
  double barrier;      ///< J
};

inline constexpr PiercedCase kPiercedCases[] = {
    {"pierced", 0.018, 0.05, 0},              // as it is
    {"pierced_smooth", 0.018, 0, 0},          //
    {"pierced_slick", 0.018, 0.01, 0},        //
    {"pierced_rubbed", 0.018, 0.3, 0},        //
    {"pierced_stuck", 0.018, 2, 0},           //
    {"pierced_barrier", 0.018, 0.05, 5e-13},  // a third of the crack's energy at the onset
    {"pierced_soft", 0.0037, 0.05, 0},        // a hole of 0.89 of the tip's radius; the limit is 0.9
    {"pierced_tough", 0.062, 0.05, 0},        // of 0.15, the limit
    {"pierced_never", 0.018, 0.05, 1}         // no depth is enough
};

/// Such a cell as a session serves it: the force of a family's member until the layer fails, then that of its
/// PiercedBranch.
class ServedPiercedCell {
 public:
  /// Solves the branch where the cache has none. @throws ConfigError
  explicit ServedPiercedCell(const PiercedCase& of);

  std::unique_ptr<PuncturableCell> make() const;

  /// Whose needle breaks through where it is 0.8 times as deep as `pressed` (N) presses a spring of `stiffness` (N/m),
  /// with that share of that force.
  TeleoperationLoop::Touched makeTouched(double stiffness, double pressed) const;

  double radius() const { return scene_.radius(); }              ///< m
  double tipRadius() const { return scene_.needle.tip.radius; }  ///< m
  const PiercedBranch::Onset& onset() const { return onset_; }   ///< without a barrier for one that is never pierced

 private:
  Scene scene_;
  std::shared_ptr<const SurrogateData> data_;
  std::optional<PiercedBranch> branch_;
  PiercedBranch::Onset onset_;
};

/// What a needle gets back that goes in and out of the cell, again and again.
struct WaysOfNeedle {
  int ways = 0, pierced = 0;  ///< from out of the cell until it is out again; those that made a hole
  double largest_given = 0;   ///< J, by the needle since a way's start, at the most
  double least_energy = 0;    ///< J, same, at the least
};

/// On random ways along the pipette, up to three onsets deep, with reversals, at 1 to 300 um/s, 1 kHz, beside the
/// axis by up to a tip's radius and, in the hole, to the side. Each second way is through the hole of the last one, if
/// that has made one.
WaysOfNeedle driveRandomWays(const ServedPiercedCell& cell, int ways, unsigned seed);

}  // namespace microinjection
