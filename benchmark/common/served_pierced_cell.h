#pragma once

#include <memory>
#include <optional>

#include "benchmark/common/teleoperation_loop.h"
#include "cell/model/piezo_stroke.h"
#include "cell/model/puncturable_cell.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// What a pierced cell has in place of the toughness and friction of config/cells/mouse_oocyte_tough.yaml.
struct PiercedCase {
  const char* name;
  double toughness;    ///< J/m^2
  double coefficient;  ///< of friction, of the wall on the shaft
  double barrier;      ///< J
  double stroke = 0;   ///< m, of a piezo that strikes ten times a second, within 50 us
  void (*more)(Scene&) = nullptr;
};

inline void addMembraneBehind(Scene& scene) {
  PunctureConfig::Layer& membrane = scene.cell.puncture.layers.emplace_back();
  membrane.name = "oolemma";
  membrane.gap = 4e-6;
  membrane.stiffness = 0.05;
  membrane.force = 0.1e-6;
}

inline constexpr PiercedCase kPiercedCases[] = {
    {"pierced", 0.018, 0.05, 0},              // as it is
    {"pierced_smooth", 0.018, 0, 0},          //
    {"pierced_slick", 0.018, 0.01, 0},        //
    {"pierced_rubbed", 0.018, 0.3, 0},        //
    {"pierced_stuck", 0.018, 2, 0},           //
    {"pierced_barrier", 0.018, 0.05, 5e-13},  // a third of the crack's energy at the onset
    {"pierced_soft", 0.0037, 0.05, 0},        // a hole of 0.89 of the tip's radius; the limit is 0.9
    {"pierced_tough", 0.062, 0.05, 0},        // of 0.15, the limit
    {"pierced_never", 0.018, 0.05, 1},        // no depth is enough
    {"pierced_struck", 0.018, 0.05, 0, 0.5e-6},
    {"pierced_twice", 0.018, 0.05, 0, 0, addMembraneBehind},
    {"pierced_fast", 0.018, 0.05, 0, 0,  // twice as tough at 100 um/s
     [](Scene& scene) {
       scene.cell.puncture.layers.front().toughness_rate = {100e-6, 0.5};
     }},
    {"pierced_resealing", 0.018, 0.05, 0, 0, [](Scene& scene) { scene.cell.puncture.resealing_time = 0.5; }},
    {"pierced_relaxing", 0.018, 0.05, 0, 0,
     [](Scene& scene) {
       scene.cell.material().viscoelasticity.prony = {{0.5, 0.3}};
     }},
    {"pierced_tapered", 0.018, 0.05, 0, 0, [](Scene& scene) { scene.needle.tip.taper = 0.05; }}};

/// Such a cell as a session serves it: the force of a family's member until the layer fails, then that of its
/// PiercedBranch.
class ServedPiercedCell {
 public:
  /// Solves the branch where the cache has none. @throws ConfigError
  explicit ServedPiercedCell(const PiercedCase& of);

  std::unique_ptr<PuncturableCell> make() const;

  /// Whose needle breaks through where it is 0.8 times as deep as `pressed` (N) presses a spring of `stiffness` (N/m),
  /// with that share of that force. No force where the cell has none, as the bridge renders it.
  TeleoperationLoop::Touched makeTouched(double stiffness, double pressed) const;

  double radius() const { return scene_.radius(); }              ///< m
  double tipRadius() const { return scene_.needle.tip.radius; }  ///< m
  double stroke() const { return stroke_; }                      ///< m
  const PiercedBranch::Onset& onset() const { return onset_; }   ///< without a barrier for one that is never pierced

 private:
  Scene scene_;
  std::shared_ptr<const SurrogateData> data_;
  std::optional<PiercedBranch> branch_;
  PiercedBranch::Onset onset_;
  double stroke_;  // m
};

/// What a needle gets back that goes in and out of the cell, again and again.
struct WaysOfNeedle {
  int ways = 0, pierced = 0;  ///< from out of the cell until it is out again; those that made a hole
  double largest_given = 0;   ///< J, by the needle since a way's start, at the most
  double least_energy = 0;    ///< J, same, at the least
};

/// On random ways along the pipette, up to three onsets deep, with reversals, at 1/316 of `fastest` (m/s) to that,
/// beside the axis by up to a tip's radius and, in the hole, to the side. Each second way is through the hole of the
/// last one, if that has made one. The force is sampled each `period` (s), and the energy summed by the trapezoidal
/// rule, without the work of strokes.
WaysOfNeedle driveRandomWays(const ServedPiercedCell& cell, int ways, unsigned seed, double fastest, double period);

}  // namespace microinjection
