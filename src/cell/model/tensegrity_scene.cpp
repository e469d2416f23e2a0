#include "cell/model/tensegrity_scene.h"

#include "cell/model/read_quantity.h"

namespace microinjection {
namespace {

void readFilaments(ConfigReader& reader, FilamentConfig& value) {
  readQuantity(reader, "young_modulus", value.young_modulus, Range::positive(), "Pa");
  readQuantity(reader, "bending_stiffness", value.bending_stiffness, Range::positive(), "N m^2");
  reader.integer("count", value.count, {1, 1e8, false, false}, ConfigReader::kRequired);
}

void readCable(ConfigReader reader, CableConfig& value) {
  readFilaments(reader, value.filaments);
  readQuantity(reader, "prestrain", value.prestrain, Range::nonNegative(), "", ConfigReader::kRequired);
  readQuantity(reader, "retardation_time", value.retardation_time, Range::nonNegative(), "s");
}

void readStrut(ConfigReader reader, StrutConfig& value) {
  readFilaments(reader, value.filaments);
  readQuantity(reader, "poisson_ratio", value.poisson_ratio, Range::open(-1, 0.5), "");
  reader.choice("model", value.model, strutModels());
  reader.choice("element", value.element, strutElements());
  reader.integer("slices", value.slices, {2, 2000, false, false});
  readQuantity(reader, "bow", value.bow, Range::closed(0, 0.1), "");
}

void readMembrane(ConfigReader reader, MembraneConfig& value) {
  readQuantity(reader, "young_modulus", value.young_modulus, Range::positive(), "Pa");
  readQuantity(reader, "poisson_ratio", value.poisson_ratio, {-1, 0.5, true, false}, "");
  readQuantity(reader, "thickness", value.thickness, Range::positive(), "m");
  readQuantity(reader, "tension", value.tension, Range::nonNegative(), "N/m");
  readQuantity(reader, "retardation_time", value.retardation_time, Range::nonNegative(), "s");
  reader.integer("divisions", value.divisions, {1, 40, false, false});
}

}  // namespace

void readTensegrity(ConfigReader& cell, TensegrityConfig& value) {
  double diameter = 2 * value.radius;
  readQuantity(cell, "diameter", diameter, Range::positive(), "m", ConfigReader::kRequired);
  value.radius = diameter / 2;
  cell.choice("orientation", value.orientation, tensegrityOrientations());
  readCable(cell.section("actin", ConfigReader::kRequired), value.actin);
  readCable(cell.section("intermediate_filaments", ConfigReader::kRequired), value.intermediate);
  readStrut(cell.section("microtubules", ConfigReader::kRequired), value.microtubules);
  readMembrane(cell.section("membrane"), value.membrane);
  if (cell.has("cut")) {
    value.cut = {0};
    cell.integer("cut", value.cut[0], {0, 35, false, false});
  }
}

}  // namespace microinjection
