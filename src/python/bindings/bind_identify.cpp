// identify().

#include <pybind11/stl.h>

#include <tuple>

#include "base/errors.h"
#include "cell/identification/combined_modulus.h"
#include "cell/identification/family_law.h"
#include "cell/identification/formula_law.h"
#include "cell/identification/identification.h"
#include "cell/identification/rival_cells.h"
#include "cell/identification/table_law.h"
#include "cell/identification/tongue_identification.h"
#include "python/bindings/arrays.h"
#include "python/bindings/module.h"
#include "python/bindings/scene_value.h"
#include "session/session_paths.h"

namespace microinjection {

namespace py = pybind11;

namespace {

py::dict toDict(const Identification& found) {
  py::dict estimates, result;
  for (const Estimate& each : found.estimates) {
    py::dict estimate;
    estimate["value"] = each.value;
    estimate["low"] = each.low;
    estimate["high"] = each.high;
    estimate["bounded"] = each.bounded();
    estimate["unit"] = each.unit;
    estimates[py::str(each.name)] = estimate;
  }
  result["model"] = found.model;
  result["estimates"] = estimates;
  result["consistent"] = found.consistent();
  result["determined"] = found.undetermined() == nullptr;
  result["noise"] = found.noise;
  result["misfit"] = found.misfit;
  result["depth"] = found.depth;
  result["warnings"] = found.warnings;
  result["residuals"] = toArray(found.residuals);
  return result;
}

ForceCurve read(const std::string& path, const py::dict& columns, const py::object& spring_constant,
                const std::string& segment, bool whole) {
  ForceCurveConfig config;
  for (const auto& [quantity, column] : columns)
    config.columns[py::str(quantity).cast<std::string>()] = py::str(column).cast<std::string>();
  if (!spring_constant.is_none()) config.spring_constant = spring_constant.cast<double>();
  config.segment = segment;
  config.whole = whole;
  return identifiedCurve(readForceCurve(path, config));
}

std::shared_ptr<ElasticLaw> lawOf(const std::string& model, const std::optional<SceneValue>& scene,
                                  const py::object& tip_radius, const std::vector<std::string>& free,
                                  const std::string& families) {
  if (model == "family") {
    if (!scene) throw ConfigError("model = family: needs a scene");
    if (!tip_radius.is_none()) throw ConfigError("tip_radius: must be left out with model = family: the scene has it");
    return std::make_shared<FamilyLaw>(findFamily(families, scene->scene()), scene->scene(), free);
  }
  if (!free.empty()) throw ConfigError("free: needs model = family");
  if (model != "hertz" && model != "shell" && model != "membrane")
    throw ConfigError("model = " + model + ": must be one of: family, hertz, shell, membrane");
  FormulaGeometry geometry = scene ? FormulaGeometry::of(scene->scene()) : FormulaGeometry();
  if (!tip_radius.is_none()) geometry.tip_radius = tip_radius.cast<double>();
  return makeFormulaLaw(model, geometry);
}

py::dict identifyRecord(const std::string& path, const std::optional<SceneValue>& scene, const std::string& model,
                        const std::vector<std::string>& free, const py::object& tip_radius, const std::string& drift,
                        int prony_terms, bool intervals, const py::dict& columns, const py::object& spring_constant,
                        const std::string& segment, bool whole, const py::object& families, double calibration_error) {
  const std::string folder =
      families.is_none() ? packageFolder() + "/config/families" : py::str(families).cast<std::string>();
  const ForceCurve curve = read(path, columns, spring_constant, segment, whole);
  const std::shared_ptr<ElasticLaw> law = lawOf(model, scene, tip_radius, free, folder);
  IdentificationConfig config;
  if (drift != "auto" && drift != "on" && drift != "off")
    throw ConfigError("drift = " + drift + ": must be auto, on or off");
  config.drift = drift == "on" ? Drift::kOn : drift == "off" ? Drift::kOff : Drift::kAuto;
  if (prony_terms < 0 || prony_terms > 3)
    throw ConfigError("prony_terms = " + std::to_string(prony_terms) + ": must be from 0 to 3");
  config.prony_terms = prony_terms;
  config.intervals = intervals;
  if (!(calibration_error >= 0 && calibration_error <= 1))
    throw ConfigError("calibration_error = " + std::to_string(calibration_error) + ": must be in [0, 1]");
  config.calibration_error = calibration_error;
  if (model == "family" && prony_terms == 0)
    config.rivals = std::make_shared<const std::vector<RivalCell>>(rivalCells(loadFamilies(folder), scene->scene()));
  Identification found;
  {
    const py::gil_scoped_release others;
    found = identify(curve, law, config);
  }
  py::dict result = toDict(found);
  result["notes"] = curve.notes;
  Eigen::VectorXd position = Eigen::Map<const Eigen::VectorXd>(curve.position.data(), curve.position.size());
  Eigen::VectorXd force = Eigen::Map<const Eigen::VectorXd>(curve.force.data(), curve.force.size());
  result["position"] = toArray(position);
  result["force"] = toArray(force);
  return result;
}

py::dict identifyTongues(const py::object& pressures, const py::object& lengths, const SceneValue& scene) {
  const Eigen::VectorXd pressure = vectorOf("pressure", pressures), length = vectorOf("length", lengths);
  if (pressure.size() != length.size())
    throw ConfigError("length: must be " + std::to_string(pressure.size()) + " numbers, as pressure is");
  TongueRecord record;
  record.pressure.assign(pressure.data(), pressure.data() + pressure.size());
  record.length.assign(length.data(), length.data() + length.size());
  for (const double each : record.pressure) {
    if (!(each <= 0)) throw ConfigError("pressure: must be at most 0 Pa: suction");
  }
  Identification found;
  {
    const py::gil_scoped_release others;
    found = identifyTongue(record, scene.scene(), TongueShape(scene.scene()));
  }
  return toDict(found);
}

Identification withModulus(const std::tuple<double, double, double, bool>& told) {
  const auto [value, low, high, bounded] = told;
  if (!(low > 0 && low < value && value < high))
    throw ConfigError("young_modulus: must lie within its interval, above 0");
  Identification found;
  found.estimates = {{"young_modulus", "Pa", value, low, high, bounded}};
  return found;
}

}  // namespace

void bindIdentify(py::module_& module) {
  module.def("identify_record", &identifyRecord, py::arg("path"), py::arg("scene"), py::arg("model"), py::arg("free"),
             py::arg("tip_radius"), py::arg("drift"), py::arg("prony_terms"), py::arg("intervals"), py::arg("columns"),
             py::arg("spring_constant"), py::arg("segment"), py::arg("whole"), py::arg("families"),
             py::arg("calibration_error"));
  using Modulus = std::tuple<double, double, double, bool>;
  module.def(
      "combine_moduli",
      [](const Modulus& force, const Modulus& tongue) {
        return toDict(combineModuli(withModulus(force), withModulus(tongue)));
      },
      py::arg("force"), py::arg("tongue"));
  module.def("identify_tongue", &identifyTongues, py::arg("pressure"), py::arg("length"), py::arg("scene"));
}

}  // namespace microinjection
