#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cell/family/family_data.h"
#include "cell/identification/elastic_law.h"

namespace microinjection {

/// The force on the axis of a family's member. The modulus is that of the outermost layer. Its
/// parameters are the ratios that are named among those that vary in the family.
class FamilyLaw : public ElasticLaw {
 public:
  /// `scene`: sizes, and all ratios to begin with. Throws ConfigError when the family does not contain
  /// it, or has no such ratio.
  FamilyLaw(std::shared_ptr<const FamilyData> family, const Scene& scene, const std::vector<std::string>& free_ratios);

  std::string description() const override;
  std::vector<Parameter> parameters() const override;
  void set(const Eigen::VectorXd& values) override;
  Value force(double depth, Eigen::VectorXd& by_logarithms) const override;
  double deepest() const override { return deepest_; }
  double error() const override { return member_.median_error; }

  /// The member's coordinates in its family.
  const Eigen::VectorXd& coordinates() const { return coordinates_; }

 private:
  Value axisForce(const ForceField::Local& local, double depth) const;
  ForceField::Local localOf(const SurrogateData& cell) const;
  SurrogateData cellAt(const Eigen::VectorXd& coordinates) const;

  std::shared_ptr<const FamilyData> family_;
  double radius_;                ///< m
  Eigen::VectorXd coordinates_;  ///< of the member
  std::vector<int> free_;        ///< indices of the family's parameters
  SurrogateData member_;
  ForceField::Local local_;
  std::vector<ForceField::Local> above_, below_;  ///< for each free ratio, a step of its logarithm away
  double deepest_ = 0;
};

/// The family in `folder` that serves the scene with the smallest error. Throws ConfigError with the
/// reason when none does.
std::shared_ptr<const FamilyData> findFamily(const std::string& folder, const Scene& scene);

}  // namespace microinjection
