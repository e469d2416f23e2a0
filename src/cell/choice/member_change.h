#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cell/family/family_cell.h"
#include "cell/model/cell_parameters.h"
#include "cell/surrogate/surrogate_cell_model.h"

namespace microinjection {

/// Changes the cell that is served to another member of its family, while a needle may touch it.
/// Call it in one thread at a time, other than the one that steps the cell.
class MemberChange {
 public:
  /// `cell` outlives this. `held_family`: of ServingPlan.
  MemberChange(const Scene& scene, std::shared_ptr<const FamilyData> family, SurrogateCellModel& cell,
               std::string held_family = "")
      : scene_(scene), family_(std::move(family)), cell_(cell), held_family_(std::move(held_family)) {}

  /// Takes milliseconds; the cell takes the member over at its next step. Returns one line that
  /// describes it. Throws ConfigError, and then changes nothing, when a parameter is invalid or the
  /// family, or that of held forces, does not contain that cell.
  std::string change(const std::vector<CellParameter>& parameters);

 private:
  Scene scene_;  ///< that is served, or will be; glued where it has a mouth
  std::shared_ptr<const FamilyData> family_;
  SurrogateCellModel& cell_;
  std::string held_family_;
};

}  // namespace microinjection
