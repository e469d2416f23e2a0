#pragma once

#include <memory>
#include <string>

#include "cell/choice/member_change.h"
#include "cell/model/cell_model.h"
#include "cell/model/explicit_cell_model.h"
#include "cell/model/online_cell_model.h"

namespace microinjection {

struct ChosenCellModel {
  std::unique_ptr<CellModel> cell;
  std::string description;  ///< user-readable: the model and why it was chosen
  bool as_required = true;  ///< else `description` is a warning
  /// Of the cell while it is served. Null when it cannot change: `unchangeable` is the reason.
  std::unique_ptr<MemberChange> change{};
  std::string unchangeable{};
};

struct CellModelConfig {
  std::string families;  ///< folder of family files; empty: none
  OnlineCellModelConfig online;
  ExplicitCellModelConfig explicit_dynamics;
};

/// A scene's cell for a moving needle. `model`: prepared (the scene's own data of `prepare`, or a
/// family's, whichever are more exact), live (see makeOnlineCell), explicit (ExplicitCellModel) or
/// auto (chosen by the scene's requirements, see chooseModel; live without data). It never replaces
/// a model that was requested by name.
/// `path`: of the scene, for messages. Throws ConfigError when the model cannot serve the scene.
ChosenCellModel makeCellModel(const Scene& scene, const std::string& model, const CellModelConfig& config,
                              const std::string& path);

}  // namespace microinjection
