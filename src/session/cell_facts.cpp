#include "session/cell_facts.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/config_reader.h"
#include "base/errors.h"
#include "base/plausible.h"
#include "session/parameter_tree.h"

namespace microinjection {
namespace {

struct Layer {
  double radius = 0, modulus = 0;  // m, Pa
};

/// A layer adds its modulus over that of the inside by the square of its share of the volume. The converged forces of
/// mouse_oocyte_zona and zebrafish_embryo at half a radius are within a third of this estimate.
double feltModulus(const std::vector<Layer>& layers) {
  double felt = layers.back().modulus;
  for (std::size_t i = layers.size() - 1; i-- > 0;) {
    const double share = 1 - std::pow(layers[i + 1].radius / layers[i].radius, 3);
    felt += (layers[i].modulus - felt) * share * share;
  }
  return felt;
}

class SceneReader {
 public:
  explicit SceneReader(const std::string& path) : scene_(loadYamlMap(path)), path_(path) {}

  CellFacts read() {
    CellFacts facts;
    const YAML::Node model = parameterAt(scene_, "cell/model");
    const bool is_tensegrity = model.IsDefined() && model.IsScalar() && model.Scalar() == "tensegrity";
    const std::vector<Layer> layers = readLayers(is_tensegrity);
    facts.radius = layers.front().radius;
    facts.modulus = is_tensegrity ? CellFacts::kModulus : feltModulus(layers);
    facts.puncture_force = readPunctureForce();
    facts.tip_radius = positive(plausible::kTipRadius, "needle/tip/radius");
    const bool is_glued = !parameterAt(scene_, "holding_pipette/mouth").IsDefined();
    facts.mouth_radius = optional(is_glued ? "holding_pipette/contact_radius" : "holding_pipette/mouth/inner_radius");
    if (!errors_.empty()) throw ConfigError(errors_);
    return facts;
  }

 private:
  bool isList(const std::string& path) const {
    const YAML::Node node = parameterAt(scene_, path);
    return node.IsDefined() && node.IsSequence() && node.size() > 0;
  }

  std::vector<Layer> readLayers(bool is_tensegrity) {
    if (!isList("cell/layers")) {
      const double modulus =
          is_tensegrity ? CellFacts::kModulus : positive(plausible::kCellModulus, "cell/material/young_modulus");
      return {{positive(plausible::kCellDiameter, "cell/diameter") / 2, modulus}};
    }
    std::vector<Layer> layers;
    const YAML::Node list = parameterAt(scene_, "cell/layers");
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string name = "cell/layers/" + std::to_string(i) + "/";
      layers.push_back({positive(i == 0 ? plausible::kCellRadius : plausible::kLength, list[i], "outer_radius", name),
                        positive(plausible::kCellModulus, list[i], "material/young_modulus", name)});
    }
    return layers;
  }

  double readPunctureForce() {
    if (!isList("cell/puncture/layers")) return optional("cell/puncture/force");
    double largest = 0;
    const YAML::Node list = parameterAt(scene_, "cell/puncture/layers");
    for (std::size_t i = 0; i < list.size(); ++i) {
      const YAML::Node force = parameterAt(list[i], "force");
      if (force.IsDefined())
        largest = std::max(largest, number(force, "cell/puncture/layers/" + std::to_string(i) + "/force"));
    }
    return largest;
  }

  double optional(const std::string& path) {
    const YAML::Node node = parameterAt(scene_, path);
    return node.IsDefined() ? number(node, path) : 0;
  }
  double positive(const PlausibleRange& range, const std::string& path) { return positive(range, scene_, path, ""); }
  double positive(const PlausibleRange& range, const YAML::Node& map, const std::string& path,
                  const std::string& prefix) {
    const YAML::Node node = parameterAt(map, path);
    if (!node.IsDefined()) {
      errors_.push_back("scene " + path_ + ": " + prefix + path + " is missing; must be a number above 0");
      return 1;
    }
    double value = range.range.low;
    if (!read(node, prefix + path, value)) return 1;
    const std::string text = "scene " + path_ + ": " + prefix + path + " = " + numberText(value) + ": must be ";
    if (!(value > 0))
      errors_.push_back(text + "above 0");
    else if (!range.range.contains(value))
      errors_.push_back(text + range.allowed(value));
    return value > 0 ? value : 1;
  }
  double number(const YAML::Node& node, const std::string& path) {
    double value = 1;
    return read(node, path, value) ? value : 1;
  }
  bool read(const YAML::Node& node, const std::string& path, double& value) {
    if (node.IsScalar() && YAML::convert<double>::decode(node, value) && std::isfinite(value)) return true;
    errors_.push_back("scene " + path_ + ": " + path + ": must be a number");
    return false;
  }

  YAML::Node scene_;
  std::string path_;
  std::vector<std::string> errors_;
};

}  // namespace

CellFacts CellFacts::ofScene(const std::string& path) { return SceneReader(path).read(); }

}  // namespace microinjection
