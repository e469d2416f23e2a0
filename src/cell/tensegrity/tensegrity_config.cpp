#include "cell/tensegrity/tensegrity_config.h"

#include <cmath>

#include "base/config_errors.h"
#include "base/errors.h"

namespace microinjection {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kCables = 36;

bool positive(double value) { return std::isfinite(value) && value > 0; }
bool notNegative(double value) { return std::isfinite(value) && value >= 0; }

void checkFilaments(const FilamentConfig& filaments, const std::string& path, ConfigErrors& errors) {
  errors.require(positive(filaments.young_modulus), path + "young_modulus", filaments.young_modulus, " Pa",
                 "positive (Pa)");
  errors.require(positive(filaments.bending_stiffness), path + "bending_stiffness", filaments.bending_stiffness,
                 " N m^2", "positive (N m^2)");
  errors.require(filaments.count >= 1, path + "count", filaments.count, "", "1 or more");
}

void checkCable(const CableConfig& cable, const std::string& path, ConfigErrors& errors) {
  checkFilaments(cable.filaments, path, errors);
  errors.require(notNegative(cable.prestrain), path + "prestrain", cable.prestrain, "", "0 or more");
  errors.require(notNegative(cable.retardation_time), path + "retardation_time", cable.retardation_time, " s",
                 "0 or more s");
}

void checkStrut(const StrutConfig& strut, ConfigErrors& errors) {
  const std::string path = "microtubules/";
  checkFilaments(strut.filaments, path, errors);
  errors.require(strut.poisson_ratio > -1 && strut.poisson_ratio < 0.5, path + "poisson_ratio", strut.poisson_ratio, "",
                 "in (-1, 0.5)");
  errors.requireOneOf(strutModels(), path + "model", strut.model);
  errors.requireOneOf(strutElements(), path + "element", strut.element);
  errors.require(strut.slices >= 2 && strut.slices % 2 == 0, path + "slices", strut.slices, "", "even, 2 or more");
  errors.require(strut.bow >= 0 && strut.bow <= 0.1, path + "bow", strut.bow, "", "in [0, 0.1]");
}

void checkMembrane(const MembraneConfig& membrane, ConfigErrors& errors) {
  const std::string path = "membrane/";
  errors.require(positive(membrane.young_modulus), path + "young_modulus", membrane.young_modulus, " Pa",
                 "positive (Pa)");
  errors.require(membrane.poisson_ratio > -1 && membrane.poisson_ratio <= 0.5, path + "poisson_ratio",
                 membrane.poisson_ratio, "", "in (-1, 0.5]");
  errors.require(positive(membrane.thickness), path + "thickness", membrane.thickness, " m", "positive (m)");
  errors.require(notNegative(membrane.tension), path + "tension", membrane.tension, " N/m", "0 or more N/m");
  errors.require(notNegative(membrane.retardation_time), path + "retardation_time", membrane.retardation_time, " s",
                 "0 or more s");
  errors.require(membrane.divisions >= 1 && membrane.divisions <= 40, path + "divisions", membrane.divisions, "",
                 "in [1, 40]");
}

}  // namespace

double FilamentConfig::filamentSection() const { return std::sqrt(4 * kPi * bending_stiffness / young_modulus); }
double FilamentConfig::filamentRadius() const { return std::sqrt(filamentSection() / kPi); }
double FilamentConfig::radius() const { return std::sqrt(section() / kPi); }
double FilamentConfig::bendingStiffness() const { return bending_stiffness * count * count; }
double FilamentConfig::eulerLoad(double length) const { return kPi * kPi * bendingStiffness() / (length * length); }

TensegrityConfig::TensegrityConfig() {
  actin.filaments = {1.95e9, 7e-26, 1};
  intermediate.filaments = {0.35e9, 8e-27, 1};
  microtubules.filaments = {1.2e9, 2.6e-23, 1};
}

bool TensegrityConfig::viscous() const {
  return actin.retardation_time > 0 || intermediate.retardation_time > 0 || membrane.retardation_time > 0;
}

std::vector<std::string> TensegrityConfig::errors() const {
  ConfigErrors errors;
  errors.require(positive(radius), "diameter", 2 * radius, " m", "positive (m)");
  errors.requireOneOf(tensegrityOrientations(), "orientation", orientation);
  checkCable(actin, "actin/", errors);
  checkCable(intermediate, "intermediate_filaments/", errors);
  checkStrut(microtubules, errors);
  checkMembrane(membrane, errors);
  for (const int cable : cut) {
    errors.require(cable >= 0 && cable < kCables, "cut", cable, "", "numbers of cables, 0 to 35");
  }
  // Otherwise the pairs of struts close up, see TensegrityGeometry.
  const bool balanced = intermediate.tension() == 0 || intermediate.tension() < 1.4 * actin.tension();
  errors.require(balanced, "intermediate_filaments/prestrain", intermediate.prestrain, "",
                 "such that the tension is below 1.4 times that of the actin cables, which alone keep parallel struts "
                 "apart");
  return errors.messages();
}

void TensegrityConfig::validate() const {
  const std::vector<std::string> messages = errors();
  if (!messages.empty()) throw ConfigError(messages);
}

const std::vector<std::string>& tensegrityOrientations() {
  static const std::vector<std::string> names = {"face", "edge", "vertex"};
  return names;
}

const std::vector<std::string>& strutModels() {
  static const std::vector<std::string> names = {"linear", "st_venant_kirchhoff", "corotated"};
  return names;
}

const std::vector<std::string>& strutElements() {
  static const std::vector<std::string> names = {"p1", "p2"};
  return names;
}

}  // namespace microinjection
