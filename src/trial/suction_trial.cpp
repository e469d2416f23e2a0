#include "trial/suction_trial.h"

namespace microinjection {

SuctionTrial SuctionTrial::run(const TrialCell& cell, const BoreTongue& tongue, int seed, Witnesses witnesses) {
  constexpr double kLongest = 180;  // s of virtual time
  SuctionTrial trial;
  trial.of = randomSuctionCase(seed);
  trial.breaks = trial.of.cell.puncture.layers.back().aspiration->mode != "none";
  ScaledCell scaled(cell.scene, cell.data, trial.of.cell, tongue);
  InjectionRig::Config config;
  config.controller = suctionSettings(trial.of);
  config.sensor.seed = seed;
  config.manipulator.seed = seed;
  config.injector.pipette = trial.of.pipette;
  config.injector.balance = PipetteFlow(trial.of.pipette).restPressure();
  config.interface.seen = witnesses != Witnesses::kForce;
  if (witnesses == Witnesses::kImage) config.controller.break_detection.fall = 1;  // of all of it: never
  config.interface.seed = static_cast<unsigned>(seed);
  config.start = startOf(trial.of);
  InjectionRig rig(config, geometryOf(cell.urdf), scaled);
  const auto drawing = [&] { return rig.controller().injection() == InjectionState::kAspirate; };
  rig.step();
  while (rig.controller().busy() && rig.time() < kLongest) {
    rig.step();
    const auto pulse = rig.controller().pulse();
    const double suction = drawing() && pulse ? config.injector.balance - pulse->pressure : 0;
    if (drawing()) trial.samples.push_back({rig.time(), suction, rig.reading().x(), scaled.boreLength()});
  }
  rig.holds();  // what flows in after the end counts, too
  trial.truth = rig.truth();
  trial.result = rig.controller().result();
  return trial;
}

}  // namespace microinjection
