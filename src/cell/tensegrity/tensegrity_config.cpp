#include "cell/tensegrity/tensegrity_config.h"

#include <cmath>

#include "base/config_errors.h"
#include "base/errors.h"

namespace microinjection {
namespace {

constexpr int kCables = 36;

void checkFilaments(const FilamentConfig& filaments, const std::string& path, ConfigErrors& errors) {
  errors.require(Range::positive(), path + "young_modulus", filaments.young_modulus, " Pa");
  errors.require(Range::positive(), path + "bending_stiffness", filaments.bending_stiffness, " N m^2");
  errors.require(filaments.count >= 1, path + "count", filaments.count, "", "1 or more");
}

void checkCable(const CableConfig& cable, const std::string& path, ConfigErrors& errors) {
  checkFilaments(cable.filaments, path, errors);
  errors.require(Range::nonNegative(), path + "prestrain", cable.prestrain);
  errors.require(Range::nonNegative(), path + "retardation_time", cable.retardation_time, " s");
}

void checkStrut(const StrutConfig& strut, ConfigErrors& errors) {
  const std::string path = "microtubules/";
  checkFilaments(strut.filaments, path, errors);
  errors.require(Range::open(-1, 0.5), path + "poisson_ratio", strut.poisson_ratio);
  errors.requireOneOf(strutModels(), path + "model", strut.model);
  errors.requireOneOf(strutElements(), path + "element", strut.element);
  errors.require(strut.slices >= 2 && strut.slices % 2 == 0, path + "slices", strut.slices, "", "even, 2 or more");
  errors.require(Range::closed(0, 0.1), path + "bow", strut.bow);
}

void checkMembrane(const MembraneConfig& membrane, ConfigErrors& errors) {
  const std::string path = "membrane/";
  errors.require(Range::positive(), path + "young_modulus", membrane.young_modulus, " Pa");
  errors.require(Range{-1, 0.5, true, false}, path + "poisson_ratio", membrane.poisson_ratio);
  errors.require(Range::positive(), path + "thickness", membrane.thickness, " m");
  errors.require(Range::nonNegative(), path + "tension", membrane.tension, " N/m");
  errors.require(Range::nonNegative(), path + "retardation_time", membrane.retardation_time, " s");
  errors.require(Range::closed(1, 40), path + "divisions", membrane.divisions);
}

}  // namespace

double FilamentConfig::filamentSection() const { return std::sqrt(4 * M_PI * bending_stiffness / young_modulus); }
double FilamentConfig::filamentRadius() const { return std::sqrt(filamentSection() / M_PI); }
double FilamentConfig::radius() const { return std::sqrt(section() / M_PI); }
double FilamentConfig::bendingStiffness() const { return bending_stiffness * count * count; }
double FilamentConfig::eulerLoad(double length) const { return M_PI * M_PI * bendingStiffness() / (length * length); }

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
  errors.require(Range::positive().contains(radius), "diameter", 2 * radius, " m", "positive (m)");
  errors.requireOneOf(tensegrityOrientations(), "orientation", orientation);
  checkCable(actin, "actin/", errors);
  checkCable(intermediate, "intermediate_filaments/", errors);
  checkStrut(microtubules, errors);
  checkMembrane(membrane, errors);
  for (const int cable : cut) {
    errors.require(cable >= 0 && cable < kCables, "cut", cable, "", "numbers of cables, 0 to 35");
  }
  // Otherwise the pairs of struts collapse, see TensegrityGeometry.
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
