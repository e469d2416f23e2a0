// Trial: an injection of a random cell, one millisecond after another.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <string>

#include "base/errors.h"
#include "cell/family/family_cell.h"
#include "operation/control/injection_state.h"
#include "python/bindings/arrays.h"
#include "python/bindings/module.h"
#include "session/session_paths.h"
#include "trial/hand_trial.h"
#include "trial/suction_trial.h"

namespace microinjection {

namespace py = pybind11;

namespace {

/// The cell that all random ones are made from, read once in a process.
const TrialCell& trialCell() {
  static const TrialCell cell = [] {
    const Scene scene = loadScene(packageFolder() + "/config/cells/mouse_oocyte_pipette.yaml");
    std::string reason;
    const auto member = findFamilyCell(packageFolder() + "/config/families", scene, reason);
    if (!member) throw ConfigError("the trial's cell is in no family: " + reason);
    return TrialCell{scene, member->data, packageFolder() + "/urdf/rig.urdf"};
  }();
  return cell;
}

/// The tongue of a bore in a cell of any size, over the bore's radius: solved once in a process.
const BoreTongue& trialTongue() {
  static const BoreTongue tongue = [] {
    Scene scene = trialCell().scene;
    scene.needle.bore_radius = 0.85 * scene.needle.tip.radius;
    return solveBoreTongue(scene);
  }();
  return tongue;
}

py::dict suctionTrial(int seed, const std::string& witnesses) {
  using Witnesses = SuctionTrial::Witnesses;
  const std::map<std::string, Witnesses> all = {
      {"both", Witnesses::kBoth}, {"force", Witnesses::kForce}, {"image", Witnesses::kImage}};
  const auto found = all.find(witnesses);
  if (found == all.end()) throw ConfigError("witnesses: must be both, force or image");
  const SuctionTrial trial = [&] {
    py::gil_scoped_release release;
    return SuctionTrial::run(trialCell(), trialTongue(), seed, found->second);
  }();
  py::dict result;
  result["breaks"] = trial.breaks;
  result["broken"] = trial.truth.punctures > 0;
  result["broken_by_suction"] = trial.truth.broken_by_suction;
  result["detected"] = trial.result.punctures > 0;
  result["outcome"] = toText(trial.result.outcome);
  result["reason"] = trial.result.reason;
  result["suction_Pa"] = trial.result.break_suction;
  result["latency_s"] = trial.truth.suction_latency.value_or(NAN);
  result["drawn_too_much_m3"] = trial.truth.drawn_too_much;
  result["false_alarms"] = trial.result.false_breaks;
  result["modulus_Pa"] = trial.of.cell.young_modulus;
  result["bore_radius_m"] = trial.of.cell.bore_radius;
  Eigen::Matrix4Xd samples(4, trial.samples.size());
  for (std::size_t i = 0; i < trial.samples.size(); ++i) {
    const SuctionTrial::Sample& sample = trial.samples[i];
    samples.col(static_cast<Eigen::Index>(i)) << sample.time, sample.suction, sample.force, sample.length;
  }
  result["samples"] = rowsOf(samples);
  return result;
}

py::object faultOf(const HandTrial& trial) {
  const InjectionRig::Disturbance& fault = trial.fault();
  if (fault.kind == InjectionRig::Disturbance::Kind::kNone) return py::none();
  py::dict result;
  result["kind"] = toText(fault.kind);
  result["begin_s"] = fault.begin;
  result["size"] = fault.size;
  return std::move(result);
}

PyArray observationOf(const HandTrial& trial) { return toArray(Eigen::VectorXd(trial.observation())); }

}  // namespace

void bindTrial(py::module_& module) {
  py::class_<HandTrial>(module, "Trial")
      .def(py::init([](int seed, double force_delay, double noise, double faults) {
             HandTrial::Config config;
             config.seed = seed;
             config.force_delay = force_delay;
             config.noise = noise;
             config.faults = faults;
             return std::make_unique<HandTrial>(trialCell(), config);
           }),
           py::arg("seed"), py::kw_only(), py::arg("force_delay") = 0.0, py::arg("noise") = 1.0,
           py::arg("faults") = 0.0)
      .def(
          "step",
          [](HandTrial& trial, double vx, double vy, double vz, bool inject, int steps) {
            trial.step({vx, vy, vz}, inject, steps);
            return observationOf(trial);
          },
          py::arg("vx"), py::arg("vy"), py::arg("vz"), py::arg("inject") = false, py::arg("steps") = 1)
      .def_property_readonly("observation", &observationOf)
      .def_property_readonly("over", &HandTrial::over)
      .def_property_readonly("state", &HandTrial::state)
      .def_property_readonly("notice", &HandTrial::notice)
      .def_property_readonly("true_force", &HandTrial::trueForce)
      .def_property_readonly("fault", &faultOf)
      .def("score", [](const HandTrial& trial) {
        const TrainingScore score = trial.score();
        py::dict measures, result;
        std::size_t i = 0;
        for (const TrainingMeasure& measure : score.measures(trial.task())) {
          py::dict one;
          one["value"] = measure.value;
          one["reference"] = measure.reference;
          one["points"] = score.points[i++];
          measures[measure.key] = one;
        }
        result["outcome"] = toText(score.outcome);
        result["reason"] = score.reason;
        result["score"] = score.score();
        result["measures"] = measures;
        return result;
      });
  module.def("suction_trial", &suctionTrial, py::arg("seed"), py::kw_only(), py::arg("witnesses") = "both");
  py::list names;
  for (const char* name : HandTrial::kObservation) names.append(name);
  module.attr("trial_observation") = py::tuple(names);
  py::list states;  // an observation has the number of its state
  for (std::size_t i = 0; i < kInjectionStates.size(); ++i) states.append(toText(static_cast<InjectionState>(i)));
  module.attr("trial_states") = py::tuple(states);
}

}  // namespace microinjection
