#include "cell/family/family_reference.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/cache_file.h"
#include "base/errors.h"
#include "base/separated.h"

namespace microinjection {
namespace {

/// First line: another family, range or draw has another one.
std::string origin(const Family& family, int seed) {
  return "# converged places of family " + family.name() + " (" + contentHash(family.description()) + "), seed " +
         std::to_string(seed) + ", lengths over R, forces over E R^2";
}

std::string columns(const Family& family) {
  std::string names = "member";
  for (const Family::Parameter& parameter : family.parameters())
    names += std::string(",") + parameter.ratio->name + "_coordinate";
  names += ",angle,ux,uy,uz,fx,fy,fz";
  for (const int node : referenceNodes()) {
    for (const char* axis : {"x", "y", "z"}) names += std::string(",") + axis + std::to_string(node);
  }
  return names;
}

std::vector<double> numbers(const std::string& line, const std::string& where) {
  std::vector<double> values;
  for (const std::string& item : separated(line)) {
    char* end = nullptr;
    values.push_back(std::strtod(item.c_str(), &end));
    if (item.empty() || *end != '\0' || !std::isfinite(values.back())) {
      throw ConfigError(where + ": '" + item + "': must be a number");
    }
  }
  return values;
}

ReferencePlace parse(const std::vector<double>& values, int dimension) {
  ReferencePlace place;
  place.member = static_cast<int>(values[0]);
  place.coordinates = Eigen::Map<const Eigen::VectorXd>(values.data() + 1, dimension);
  const double* rest = values.data() + 1 + dimension;
  place.angle = rest[0];
  place.displacement = Eigen::Map<const Eigen::Vector3d>(rest + 1);
  place.force = Eigen::Map<const Eigen::Vector3d>(rest + 4);
  const auto size = 3 * static_cast<Eigen::Index>(referenceNodes().size());
  place.surface = Eigen::Map<const Eigen::VectorXd>(rest + 7, size).cast<float>();
  return place;
}

}  // namespace

std::string writeReferences(const Family& family, int seed, const std::vector<ReferencePlace>& places) {
  std::string text = origin(family, seed) + '\n' + columns(family) + '\n';
  const auto append = [&](const char* format, double value) {
    char number[40];
    std::snprintf(number, sizeof(number), format, value);
    text += number;
  };
  for (const ReferencePlace& place : places) {
    text += std::to_string(place.member);
    for (const double x : place.coordinates) append(",%.6g", x);
    append(",%.17g", place.angle);
    for (const double x : place.displacement) append(",%.17g", x);
    for (const double x : place.force) append(",%.9g", x);
    for (const float x : place.surface) append(",%.3g", x);
    text += '\n';
  }
  return text;
}

std::vector<ReferencePlace> readReferences(const Family& family, int seed, const std::string& path) {
  std::vector<ReferencePlace> places;
  if (!std::filesystem::exists(path)) return places;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  if (line != origin(family, seed)) {
    throw ConfigError(path + ": line 1: '" + line + "': must be '" + origin(family, seed) + "'; remove the file");
  }
  std::getline(file, line);
  if (line != columns(family)) throw ConfigError(path + ": line 2: must name the columns of this version");
  const std::size_t expected = 8 + family.dimension() + 3 * referenceNodes().size();
  for (int number = 3; std::getline(file, line); ++number) {
    const std::string where = path + ": line " + std::to_string(number);
    const std::vector<double> values = numbers(line, where);
    if (values.size() != expected) {
      throw ConfigError(where + ": " + std::to_string(values.size()) + " numbers: must be " + std::to_string(expected));
    }
    places.push_back(parse(values, family.dimension()));
  }
  return places;
}

}  // namespace microinjection
