#pragma once

#include <memory>
#include <random>
#include <string>

#include "cell/family/axis_force.h"
#include "cell/family/family_data.h"
#include "cell/model/scene.h"

namespace microinjection {

/// The data of config/families/NAME.yaml.
std::shared_ptr<const FamilyData> loadFamilyData(const std::string& name);

/// A cell that was drawn from a family, and its converged force on the axis: of the section, solved for
/// this cell, and not of the family's data.
struct DrawnCell {
  Scene scene;                  ///< with the cell's modulus
  double modulus = 0;           ///< Pa, of the outermost layer
  double length = 0, unit = 0;  ///< m, of the range on the axis; N of the curve
  AxisCurve curve;

  double force(double depth) const;  ///< N, at `depth` (m)
  Scene withModulus(double modulus) const;
};

/// At random coordinates, of 5 to 25 kPa, with `radius` (m), and prepared at least `deep` (m).
DrawnCell drawCell(const FamilyData& data, double radius, double deep, std::mt19937& random);

double uniform(double low, double high, std::mt19937& random);

}  // namespace microinjection
