#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cell/family/family.h"

namespace microinjection {

/// The tasks of one round of a family's preparation, as a file that people and job schedulers can
/// read: CSV, one task a line, below a line with the family, the members that it shall have, and a
/// checksum. The tasks depend on the family's data only, not on what has been solved.
class FamilyPlan {
 public:
  struct Task {
    Eigen::VectorXd coordinates;  ///< of the member; empty: a node of the grid of forces on the axis
    int piece = 0;                ///< path of the member, or node of the grid
  };

  /// `wanted`: members that the family shall have when all rounds are done.
  explicit FamilyPlan(const Family& family, int wanted = 0)
      : name_(family.name()), family_(family.description()), wanted_(wanted) {}

  void addAxisNodes(int nodes);
  void addMember(const Eigen::VectorXd& coordinates, std::size_t paths);

  const std::vector<Task>& tasks() const { return tasks_; }
  int wanted() const { return wanted_; }
  /// Coordinates of the members that the round adds.
  const std::vector<Eigen::VectorXd>& members() const { return members_; }

  void save(const std::string& file) const;
  /// Reads the tasks and wanted(). Throws ConfigError when the file is damaged, or of another family.
  void load(const std::string& file);

 private:
  std::string headStart() const;
  std::string head(const std::string& body) const;

  std::string name_, family_;
  int wanted_;
  std::vector<Task> tasks_;
  std::vector<Eigen::VectorXd> members_;
};

std::string coordinatesText(const Eigen::VectorXd& coordinates, char separator);
/// Empty when something in the text is no number.
std::optional<Eigen::VectorXd> parseCoordinates(const std::string& text, char separator);

}  // namespace microinjection
