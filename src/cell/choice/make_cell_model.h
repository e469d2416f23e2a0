#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cell/choice/member_change.h"
#include "cell/model/cell_model.h"
#include "cell/model/explicit_cell_model.h"
#include "cell/model/live_cell_model.h"
#include "cell/model/withdrawal_loss.h"

namespace microinjection {

struct ChosenCellModel {
  std::unique_ptr<CellModel> cell;
  std::string description;  ///< user-readable: the model and why it was chosen
  bool as_required = true;  ///< else `description` is a warning
  /// Of the cell while it is served. Null when it cannot change: `unchangeable` is the reason.
  std::unique_ptr<MemberChange> change{};
  std::string unchangeable{};
};

/// Surrogate data for a scene.
struct SurrogateSource {
  std::shared_ptr<const SurrogateData> data;  ///< none: `text` is the reason
  std::string text;                           ///< where they are from
  std::shared_ptr<const FamilyData> family;   ///< that contains the scene; null: none
  bool on_axis_only = false;                  ///< beside the axis their error is not known
};

/// The data that families have for a scene; of a needle on the axis that rubs, those of one that sticks, corrected by
/// the family of friction forces. None: no family has it, for the reason that `outside` then gives the user.
SurrogateSource findFamilySource(const Scene& scene, const std::string& families, std::string& outside);

/// A scene whose needle does not adhere: the way in is the same.
Scene withoutAdhesion(Scene scene);

enum class Served { kExplicit, kLive, kSurrogate };

/// What will serve a scene.
struct ServingPlan {
  Served served = Served::kLive;
  std::string reason;  ///< user-readable
  bool as_required = true;
  bool is_fallback = false;  ///< live, because there are no surrogate data
  SurrogateSource source{};
  /// What is served in place of the scene: one that suction holds is glued, see Scene::glued(), and a needle that
  /// adheres does so by `loss`.
  std::shared_ptr<const Scene> scene{};
  double glued_error = 0;  ///< relative, of the force on the axis, that this adds; 0: the scene is itself
  /// Folder of the families by whose held forces the surrogate data are corrected, see AxisForceRatio; empty: they are
  /// not.
  std::string held_family{};
  /// Of surrogate data, whose force is that of the way in: what a needle that rubs or adheres has less on its way out.
  /// Nothing: it does neither, or no family has it.
  std::optional<WithdrawalLoss> loss{};
};

/// The first half of makeCellModel(), for those who do not serve a moving needle. `call`: the command that prepares the
/// scene, for messages. @throws ConfigError as makeCellModel()
ServingPlan planServing(const Scene& scene, const std::string& model, const std::string& families,
                        const std::string& call);

struct CellModelConfig {
  std::string families;  ///< folder of family files; empty: none
  LiveCellModelConfig live;
  ExplicitCellModelConfig explicit_dynamics;
  std::function<void(const std::string&)> tell{};  ///< of long work, in words for users; empty: nobody
};

/// A scene's cell for a moving needle. The way goes in one direction:
///
///     model, scene --> plan: explicit | live | surrogate data, own or a family's --> tracker --> PuncturableCell
///                            (auto: chooseModel() by error and time)   WithdrawnCell, if it rubs or adheres
///
/// The plan alone knows files and figures, so that what serves a scene can be read in one place, and building it
/// cannot change the choice. A model that was requested by name is never replaced: a force of another model than the
/// one asked for would be taken for that one's.
/// @param model   surrogate (the scene's own data of `prepare`, or a family's, whichever are more exact), live (see
///                makeLiveCell), explicit (ExplicitCellModel), or auto (by the scene's requirements; live without data)
/// @param path    of the scene, for messages
/// @throws ConfigError when the model cannot serve the scene
ChosenCellModel makeCellModel(const Scene& scene, const std::string& model, const CellModelConfig& config,
                              const std::string& path);

}  // namespace microinjection
