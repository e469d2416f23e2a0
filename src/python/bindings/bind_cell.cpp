// Scene, Cell and indent().

#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <sstream>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "cell/family/tongue_family.h"
#include "cell/model/contact_frame.h"
#include "cell/model/converged_force.h"
#include "cell/model/converged_tongue.h"
#include "cell/model/similarity.h"
#include "python/bindings/arrays.h"
#include "python/bindings/module.h"
#include "python/bindings/scene_value.h"
#include "python/bindings/served_forces.h"
#include "session/session_paths.h"

namespace microinjection {

namespace py = pybind11;

namespace {

/// Ctrl-C, as Python has it: may be called without the GIL.
void checkSignals() {
  const py::gil_scoped_acquire python;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

std::string familiesOr(const py::object& families) {
  return families.is_none() ? packageFolder() + "/config/families" : py::str(families).cast<std::string>();
}

using Wanted = ServedForces::Wanted;

/// What both queries do around their arrays.
void evaluate(const ServedForces& cell, const PyPoints& tips, const py::object& axis, bool along,
              const Wanted& wanted) {
  if (!axis.is_none()) {
    if (const std::string refusal = cell.refusal(directionOf("axis", axis)); !refusal.empty())
      throw ConfigError("axis: " + refusal);
  }
  constexpr Eigen::Index kFew = 20;  // tips, that are done before another thread had the interpreter
  if (!cell.isLive() && tips.points.cols() <= kFew) return cell.evaluate(tips.points, along, wanted, checkSignals);
  const py::gil_scoped_release others;
  cell.evaluate(tips.points, along, wanted, checkSignals);
}

py::object forceOf(const ServedForces& cell, const py::object& tip, const py::object& axis, bool along) {
  const PyPoints tips("tip", tip);
  PyArray force = tips.result({3});
  evaluate(cell, tips, axis, along, {force.mutable_data(), nullptr});
  return std::move(force);
}

py::object stiffnessOf(const ServedForces& cell, const py::object& tip, const py::object& axis, bool along) {
  const PyPoints tips("tip", tip);
  PyArray stiffness = tips.result({3, 3});
  evaluate(cell, tips, axis, along, {nullptr, stiffness.mutable_data()});
  return std::move(stiffness);
}

/// Where a needle that comes straight down meets the cell at rest.
PyArray touchOf(const ServedForces& cell, const py::object& lateral) {
  const Eigen::VectorXd aside = vectorOf("lateral", lateral);
  if (aside.size() != 2) throw ConfigError("lateral: must be two numbers, x and y in m");
  const auto contact = ContactFrame::at(cell.scene(), aside);
  if (!contact) throw ConfigError("lateral: a needle there passes the cell");
  return toArray(Eigen::VectorXd(contact->origin));
}

py::dict surfaceOf(const ServedForces& cell, const py::object& tip) {
  const PyPoints tips("tip", tip);
  if (!tips.single) throw ConfigError("tip: must be one tip, of shape (3,)");
  const ServedForces::Surface surface = cell.surface(tips.points.col(0));
  py::array_t<int> triangles({static_cast<py::ssize_t>(surface.triangles.size()), py::ssize_t(3)});
  std::copy_n(surface.triangles.data()->data(), 3 * surface.triangles.size(), triangles.mutable_data());
  py::dict result;
  result["vertices"] = rowsOf(surface.vertices);
  result["at_rest"] = rowsOf(surface.at_rest);
  result["triangles"] = triangles;
  return result;
}

py::object familyName(const ServedForces& cell) {
  if (!cell.family()) return py::none();
  return py::str(cell.family()->family().name());
}

/// Each ratio of the family: its value and borders.
py::dict placeOf(const ServedForces& cell) {
  py::dict place;
  if (!cell.family()) return place;
  const Family& family = cell.family()->family();
  const auto coordinates = family.coordinatesOf(cell.scene());
  for (int i = 0; i < family.dimension(); ++i) {
    const Family::Parameter& ratio = family.parameters()[static_cast<std::size_t>(i)];
    place[ratio.ratio->name] = py::make_tuple(ratio.value((*coordinates)[i]), ratio.low, ratio.high);
  }
  return place;
}

py::dict indentScene(const SceneValue& scene, const py::object& depths, const py::object& lateral,
                     const py::object& speed, double hold, const py::object& withdrawal, double tolerance,
                     double time) {
  Indenting indenting;
  const Eigen::VectorXd in = vectorOf("depths", depths);
  indenting.depths.assign(in.data(), in.data() + in.size());
  if (!lateral.is_none()) {
    const Eigen::VectorXd aside = vectorOf("lateral", lateral);
    if (aside.size() != 2) throw ConfigError("lateral: must be two numbers, x and y in m");
    indenting.lateral = aside;
  }
  if (!speed.is_none()) indenting.speed = speed.cast<double>();
  if (indenting.speed && !(*indenting.speed > 0 && *indenting.speed < 1))
    throw ConfigError("speed: must be in (0, 1) m/s");
  if (!(hold >= 0 && hold < 1e6)) throw ConfigError("hold: must be from 0 to 1e6 s");
  indenting.hold = hold;
  if (!withdrawal.is_none()) {
    const Eigen::VectorXd out = vectorOf("withdrawal", withdrawal);
    indenting.withdrawal.assign(out.data(), out.data() + out.size());
  }
  const double diameter = scene.scene().cell.diameter();
  for (std::size_t i = 0; i < indenting.depths.size(); ++i) {
    if (indenting.depths[i] >= 0 && indenting.depths[i] <= diameter) continue;
    std::ostringstream text;
    text << "depths: value " << i << " = " << indenting.depths[i] << ": must be from 0 to the cell's diameter, "
         << diameter << " m";
    throw ConfigError(text.str());
  }
  if (!(tolerance > 0)) throw ConfigError("tolerance: must be > 0");
  indenting.validate();
  scene.scene().requireContinuum("indent()");
  ConvergedForceConfig config;
  config.tolerance = tolerance;
  config.time = time;
  std::vector<ForcePoint> points;
  {
    const py::gil_scoped_release others;
    points = ConvergedForce(scene.scene(), indenting, config).solve([](const LevelReport&) { checkSignals(); });
  }
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::VectorXd depth(count), error(count), seconds(count);
  Eigen::Matrix3Xd force(3, count);
  py::array_t<bool> converged(count);
  py::list reasons;
  for (Eigen::Index i = 0; i < count; ++i) {
    const ForcePoint& point = points[static_cast<std::size_t>(i)];
    depth[i] = point.depth;
    error[i] = point.error_estimate;
    seconds[i] = point.wall_time;
    force.col(i) = point.converged ? point.force : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    converged.mutable_at(i) = point.converged;
    reasons.append(point.reason);
  }
  py::dict result;
  result["depth"] = toArray(depth);
  result["force"] = rowsOf(force);
  result["error_estimate"] = toArray(error);
  result["converged"] = converged;
  result["reason"] = reasons;
  result["wall_time"] = toArray(seconds);
  return result;
}

py::dict aspirateScene(const SceneValue& scene, const py::object& pressures, double tolerance, double finest) {
  std::vector<double> wanted;
  if (!pressures.is_none()) {
    const Eigen::VectorXd given = vectorOf("pressures", pressures);
    wanted.assign(given.data(), given.data() + given.size());
  } else if (scene.scene().holding_pipette.mouth) {
    wanted = {scene.scene().holding_pipette.mouth->pressure};
  }
  if (!(tolerance > 0)) throw ConfigError("tolerance: must be > 0");
  if (!(finest >= 1 && finest <= 6)) throw ConfigError("finest: must be from 1 to 6");
  ConvergedTongueConfig config;
  config.tolerance = tolerance;
  config.finest = finest;
  std::vector<TonguePoint> points;
  {
    const py::gil_scoped_release others;
    points = convergedTongues(scene.scene(), wanted, config, [](double, std::size_t) { checkSignals(); });
  }
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(count, 6, std::numeric_limits<double>::quiet_NaN());
  py::array_t<bool> converged(count);
  py::list reasons, outlines;
  for (Eigen::Index i = 0; i < count; ++i) {
    const TonguePoint& point = points[static_cast<std::size_t>(i)];
    const HeldCell& held = point.held;
    values(i, 0) = held.pressure;
    if (point.converged)
      values.row(i).tail(5) << held.tongue_length, held.tongue_volume, held.seal_radius, held.clamping_force,
          point.error_estimate;
    converged.mutable_at(i) = point.converged;
    reasons.append(point.reason);
    outlines.append(point.converged ? py::object(rowsOf(held.outline)) : py::none());
  }
  py::dict result;
  int column = 0;
  for (const char* name :
       {"pressure", "tongue_length", "tongue_volume", "seal_radius", "clamping_force", "error_estimate"})
    result[name] = toArray(Eigen::VectorXd(values.col(column++)));
  result["converged"] = converged;
  result["reason"] = reasons;
  result["outline"] = outlines;
  return result;
}

/// A FamilyTongue in SI units.
class TongueValue {
 public:
  TongueValue(const Scene& scene, const std::string& families) : units_(Similarity::of(scene)) {
    std::string reason;
    tongue_ = findFamilyTongue(families, scene, reason);
    if (!tongue_) throw ConfigError("no family has the scene's tongue: " + reason);
  }

  /// Pa, gauge.
  double strongest() const { return -units_.modulus * tongue_->strongest(); }
  double end() const { return -units_.modulus * tongue_->end(); }
  bool equilibriumEnds() const { return tongue_->equilibriumEnds(); }

  py::dict at(const py::object& pressures) const {
    const Eigen::VectorXd pressure = vectorOf("pressures", pressures);
    const double length = units_.length, volume = std::pow(length, 3);
    Eigen::MatrixXd values(pressure.size(), 7);
    {
      const py::gil_scoped_release others;
      for (Eigen::Index i = 0; i < pressure.size(); ++i) {
        const DrawnTongue at = tongue_->at(-pressure[i] / units_.modulus);
        values.row(i) << length * at.length, volume * at.volume, length * at.seal_radius,
            units_.force() * at.clamping_force, -length / units_.modulus * at.length_slope,
            -volume / units_.modulus * at.volume_slope, at.expected_error;
      }
    }
    py::dict result;
    result["pressure"] = toArray(pressure);
    int column = 0;
    for (const char* name : {"tongue_length", "tongue_volume", "seal_radius", "clamping_force", "length_slope",
                             "volume_slope", "expected_error"})
      result[name] = toArray(Eigen::VectorXd(values.col(column++)));
    return result;
  }

  py::object outline(double pressure) const {
    const double suction = -pressure / units_.modulus;
    if (!(suction >= 0 && suction <= tongue_->strongest())) return py::none();
    return rowsOf(Eigen::Matrix2Xd(units_.length * tongue_->outline(suction)));
  }

 private:
  Similarity units_;
  std::optional<FamilyTongue> tongue_;
};

}  // namespace

void bindCell(py::module_& module) {
  py::class_<SceneValue>(module, "Scene")
      .def(py::init([](const py::dict& keys, const std::string& origin) { return SceneValue(toYaml(keys), origin); }),
           py::arg("keys"), py::arg("origin") = "the scene")
      .def_static(
          "load", [](const py::object& path) { return SceneValue::load(py::str(path).cast<std::string>()); },
          py::arg("path"))
      .def("replace", &SceneValue::with, py::arg("changes"))
      .def(
          "save",
          [](const SceneValue& scene, const py::object& path) {
            writeFileAtomically(py::str(path).cast<std::string>(), scene.text());
          },
          py::arg("path"))
      .def("to_dict", &SceneValue::keys)
      .def_property_readonly("origin", &SceneValue::origin)
      .def_property_readonly("diameter", [](const SceneValue& scene) { return scene.scene().cell.diameter(); })
      .def("__str__", &SceneValue::text)
      .def("__repr__", [](const SceneValue& scene) { return "<Scene of " + scene.origin() + '>'; })
      .def(
          "__eq__", [](const SceneValue& a, const SceneValue& b) { return a.text() == b.text(); }, py::is_operator())
      .def(py::pickle([](const SceneValue& scene) { return py::make_tuple(scene.text(), scene.origin()); },
                      [](const py::tuple& state) {
                        return SceneValue(YAML::Load(state[0].cast<std::string>()), state[1].cast<std::string>());
                      }));

  py::class_<ServedForces, std::shared_ptr<ServedForces>>(module, "Cell")
      .def(py::init([](const SceneValue& scene, const std::string& model, const py::object& families) {
             auto shared = std::make_shared<const Scene>(scene.scene());
             const std::string folder = familiesOr(families);
             const py::gil_scoped_release others;
             return std::make_shared<ServedForces>(shared, model, folder);
           }),
           py::arg("scene"), py::arg("model") = "auto", py::arg("families") = py::none())
      .def("force", &forceOf, py::arg("tip"), py::arg("axis") = py::none(), py::kw_only(), py::arg("along") = false)
      .def("stiffness", &stiffnessOf, py::arg("tip"), py::arg("axis") = py::none(), py::kw_only(),
           py::arg("along") = false)
      .def("touch", &touchOf, py::arg("lateral") = py::make_tuple(0, 0))
      .def("surface", &surfaceOf, py::arg("tip"))
      .def_property_readonly("model", [](const ServedForces& cell) { return cell.isLive() ? "live" : "surrogate"; })
      .def_property_readonly("description", &ServedForces::description)
      .def_property_readonly("expected_error", &ServedForces::expectedError)
      .def_property_readonly("family", &familyName)
      .def_property_readonly("place", &placeOf)
      .def_property_readonly("radius", [](const ServedForces& cell) { return cell.scene().radius(); });

  module.def("indent", &indentScene, py::arg("scene"), py::arg("depths"), py::kw_only(),
             py::arg("lateral") = py::none(), py::arg("speed") = py::none(), py::arg("hold") = 0.0,
             py::arg("withdrawal") = py::none(), py::arg("tolerance") = 0.005, py::arg("time") = 600.0);
  py::class_<TongueValue>(module, "FamilyTongue")
      .def(py::init([](const SceneValue& scene, const py::object& families) {
             return TongueValue(scene.scene(), familiesOr(families));
           }),
           py::arg("scene"), py::arg("families") = py::none())
      .def("at", &TongueValue::at, py::arg("pressures"))
      .def("outline", &TongueValue::outline, py::arg("pressure"))
      .def_property_readonly("strongest", &TongueValue::strongest)
      .def_property_readonly("end", &TongueValue::end)
      .def_property_readonly("equilibrium_ends", &TongueValue::equilibriumEnds);
  module.def("aspirate", &aspirateScene, py::arg("scene"), py::arg("pressures") = py::none(), py::kw_only(),
             py::arg("tolerance") = 0.005, py::arg("finest") = 3.0);
}

}  // namespace microinjection
