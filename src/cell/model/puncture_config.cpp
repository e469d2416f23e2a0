#include "cell/model/puncture_config.h"

#include <cmath>
#include <set>

#include "cell/model/read_quantity.h"

namespace microinjection {
namespace {

const Range kRateExponents = Range::closed(0.01, 2);

const char* const kWithToughness[] = {"barrier", "strength", "toughness_rate"};

void readToughness(ConfigReader& reader, PunctureConfig::Layer& layer) {
  readQuantity(reader, "toughness", layer.toughness, Range::positive(), "J/m^2");
  readQuantity(reader, "barrier", layer.barrier, Range::nonNegative(), "J");
  readQuantity(reader, "strength", layer.strength, Range::positive(), "Pa");
  for (const char* key : kWithToughness) {
    if (reader.has(key) && !reader.has("toughness"))
      reader.error(key, "must be left out: it belongs to toughness only");
  }
  for (const char* key : {"toughness_rate", "barrier"}) {
    if (reader.has("strength") && reader.has(key))
      reader.error("strength", std::string("must be left out where there is a ") + key);
  }
  if (!reader.has("toughness_rate")) return;
  ConfigReader rate = reader.section("toughness_rate");
  readQuantity(rate, "speed", layer.toughness_rate.speed, Range::positive(), "m/s", ConfigReader::kRequired);
  readQuantity(rate, "exponent", layer.toughness_rate.exponent, kRateExponents, "", ConfigReader::kRequired);
}

/// @param before those outside of it
void readLayer(ConfigReader reader, const std::vector<PunctureConfig::Layer>& before, PunctureConfig::Layer& layer) {
  const bool outermost = before.empty();
  const bool behind_tough = before.size() > 1 && std::isfinite(before.back().toughness);
  reader.text("name", layer.name, ConfigReader::kRequired);
  readQuantity(reader, "force", layer.force, Range::positive(), "N");
  readQuantity(reader, "depth", layer.depth, Range::positive(), "m");
  readQuantity(reader, "strain", layer.strain, Range::positive(), "");
  readToughness(reader, layer);
  const int criteria = reader.has("force") + reader.has("depth") + reader.has("strain") + reader.has("toughness");
  if (criteria != 1) reader.error("name", "must have one of force (N), depth (m), strain, toughness (J/m^2)");
  if (reader.has("strain")) {
    readQuantity(reader, "dimple_radius", layer.dimple_radius, Range::positive(), "m", ConfigReader::kRequired);
  } else if (reader.has("dimple_radius")) {
    reader.error("dimple_radius", "must be left out: it belongs to strain only");
  }
  for (const char* key : {"stiffness", "gap"}) {
    if (outermost && reader.has(key)) {
      reader.error(key, "must be left out: the outermost layer is the cell that the needle touches");
    }
  }
  if (!outermost && reader.has("toughness")) {
    if (std::isinf(before.back().toughness))
      reader.error("toughness", "must be left out: the layer before it is not pierced by mechanics");
    for (const char* key : {"barrier", "strength", "toughness_rate", "stiffness", "gap", "aspiration"}) {
      if (reader.has(key)) reader.error(key, "must be left out: a layer of the cell behind the outermost has none");
    }
    return;
  }
  if (reader.has("aspiration")) layer.aspiration = AspirationConfig::read(reader.section("aspiration"));
  if (outermost) return;
  if (behind_tough)
    reader.error("name", "must have a toughness, as the layer before it, which is not the outermost, has");
  readQuantity(reader, "stiffness", layer.stiffness, Range::positive(), "N/m", ConfigReader::kRequired);
  readQuantity(reader, "gap", layer.gap, Range::nonNegative(), "m");
}

void readShaft(const ConfigReader& reader, PunctureConfig::Shaft& shaft) {
  readQuantity(reader, "friction", shaft.friction, Range::nonNegative(), "N");
  readQuantity(reader, "coefficient", shaft.coefficient, Range::nonNegative(), "");
  readQuantity(reader, "adhesion", shaft.adhesion, Range::nonNegative(), "N/m");
  readQuantity(reader, "stiffness", shaft.stiffness, Range::positive(), "N/m");
  readQuantity(reader, "damping", shaft.damping, Range::nonNegative(), "Pa s");
  readQuantity(reader, "lateral_stiffness", shaft.lateral_stiffness, Range::nonNegative(), "N/m");
}

void checkMembrane(const PunctureConfig::Layer& layer, const std::string& path, bool outermost, double tip_radius,
                   ConfigErrors& errors) {
  errors.require(layer.force > 0, path + "force", layer.force, " N", "positive (N)");
  errors.require(layer.depth > 0, path + "depth", layer.depth, " m", "positive (m)");
  errors.require(layer.strain > 0, path + "strain", layer.strain, "", "positive");
  errors.require(layer.toughness > 0, path + "toughness", layer.toughness, " J/m^2", "positive (J/m^2)");
  errors.require(layer.toughness_rate.speed > 0, path + "toughness_rate/speed", layer.toughness_rate.speed, " m/s",
                 "positive (m/s)");
  errors.require(kRateExponents, path + "toughness_rate/exponent", layer.toughness_rate.exponent, "");
  errors.require(Range::nonNegative(), path + "barrier", layer.barrier, " J");
  errors.require(std::isinf(layer.strain) || (std::isfinite(layer.dimple_radius) && layer.dimple_radius > tip_radius),
                 path + "dimple_radius", layer.dimple_radius, " m", "above needle/tip/radius");
  errors.require(Range::nonNegative(), path + "gap", layer.gap, " m");
  errors.require(layer.strength > 0, path + "strength", layer.strength, " Pa", "positive (Pa)");
  const bool membrane = !outermost && std::isinf(layer.toughness);
  errors.require(!membrane || (std::isfinite(layer.stiffness) && layer.stiffness > 0), path + "stiffness",
                 layer.stiffness, " N/m", "positive (N/m)");
}

}  // namespace

double PunctureConfig::Layer::strainAt(double indentation, double tip_radius) const {
  return std::hypot(1, indentation / (dimple_radius - tip_radius)) - 1;
}

bool PunctureConfig::Layer::fails(double push, double indentation, double tip_radius, double strength) const {
  return push >= strength * force || indentation >= strength * depth ||
         (std::isfinite(strain) && strainAt(indentation, tip_radius) >= strength * strain);
}

double PunctureConfig::opening() const { return layers.front().toughness / (M_E * layers.front().strength); }

int PunctureConfig::toughLayers() const {
  int count = 0;
  while (count < static_cast<int>(layers.size()) && std::isfinite(layers[count].toughness)) ++count;
  return count;
}

PunctureConfig PunctureConfig::atForce(double force) {
  PunctureConfig config;
  config.layers.emplace_back().force = force;
  return config;
}

void PunctureConfig::read(ConfigReader reader) {
  if (reader.has("layers")) {
    for (ConfigReader& layer : reader.sections("layers")) {
      const std::vector<Layer> before = layers;
      readLayer(layer, before, layers.emplace_back());
    }
    if (layers.empty()) reader.error("layers", "must have at least one layer");
    for (const char* key : {"force", "toughness", "toughness_rate", "barrier", "strength"}) {
      if (reader.has(key)) reader.error(key, "must be left out where there are layers: each has its own");
    }
  } else if (reader.has("force") && (reader.has("toughness") || reader.has("toughness_rate"))) {
    reader.error(reader.has("toughness") ? "toughness" : "toughness_rate",
                 "must be left out where the force of the puncture is given");
  } else if (reader.has("force")) {
    readQuantity(reader, "force", layers.emplace_back().force, Range::positive(), "N");
  } else if (reader.has("toughness") || reader.has("toughness_rate") || reader.has("barrier") ||
             reader.has("strength")) {
    readToughness(reader, layers.emplace_back());
  }
  readShaft(reader.section("shaft"), shaft);
  readQuantity(reader, "relaxation_time", relaxation_time, Range::positive(), "s");
  readQuantity(reader, "cytoplasm_viscosity", cytoplasm_viscosity, Range::positive(), "Pa s");
  readQuantity(reader, "resealing_time", resealing_time, Range::positive(), "s");
}

void PunctureConfig::check(double tip_radius, ConfigErrors& errors) const {
  const std::string path = "cell/puncture/";
  std::set<std::string> names;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::string at = path + "layers/" + std::to_string(i) + "/";
    errors.require(!layers[i].name.empty() && names.insert(layers[i].name).second, at + "name", layers[i].name, "",
                   "a name that no other layer has");
    checkMembrane(layers[i], at, i == 0, tip_radius, errors);
    if (layers[i].aspiration) layers[i].aspiration->check(at + "aspiration/", errors);
  }
  errors.require(Range::nonNegative(), path + "shaft/friction", shaft.friction, " N");
  errors.require(Range::nonNegative(), path + "shaft/coefficient", shaft.coefficient, "");
  errors.require(Range::nonNegative(), path + "shaft/adhesion", shaft.adhesion, " N/m");
  errors.require(Range::nonNegative(), path + "shaft/damping", shaft.damping, " Pa s");
  errors.require(Range::nonNegative(), path + "shaft/lateral_stiffness", shaft.lateral_stiffness, " N/m");
  errors.require(Range::positive(), path + "shaft/stiffness", shaft.stiffness, " N/m");
  errors.require(Range::positive(), path + "relaxation_time", relaxation_time, " s");
  errors.require(Range::positive(), path + "cytoplasm_viscosity", cytoplasm_viscosity, " Pa s");
  errors.require(resealing_time > 0, path + "resealing_time", resealing_time, " s", "positive (s)");
}

}  // namespace microinjection
